#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "../../src/app/campbell.h"
#include "space_twin.h"

using namespace floe;
using namespace floe::test;

namespace {

const Rotated rotation;

/// A rod of length 1 and mass 3 about its end: I = 1. In the plane, or rotated somehow in space.
std::string rod(bool space, const std::string& rest) {
  const std::string plane = R"yaml(
bodies:
  rod:
    rigid: true
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 2}}
    section: {EA: 1, EI: 1, rhoA: 3, rhoI: 0}
joints: {hinge: {type: revolute, between: [ground, rod.start]}}
)yaml",
                    spatial = R"yaml(
bodies:
  rod:
    rigid: true
    mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: 2}}
    section: {shape: rectangle, width: 1e-4, height: 1e-4, orientation: [0, 1, 0]}
    material: {E: 1, nu: 0.3, rho: 3e8}
    initial: {rotation: $r}
joints: {hinge: {type: revolute, between: [ground, rod.start], axis: $z}}
)yaml";
  return fill(space ? spatial : plane, {{"r", rotation.text()}, {"z", rotation(0, 0, 1)}}) + rest;
}

}  // namespace

// I phi.. = -k (phi - ref) - d phi.: the step response of an oscillator with omega = sqrt(k/I), zeta = d / (2 omega I).
// The work of the moment is the kinetic energy.
TEST_CASE("state loads: a link with PD control has the closed form's step response") {
  const double omega = 5, zeta = 0.1, ref = 0.3, od = omega * std::sqrt(1 - zeta * zeta);
  for (const bool space : {false, true}) {
    const History at = move(rod(space, R"yaml(
parameters: {k: 25, d: 1, ref: 0.3}
loads: {motor: {type: moment, joint: hinge, moment: "-k*(hinge.angle - ref) - d*hinge.rate"}}
motion: {end: 2, step: 1e-3}
probes: {rod: {at: rod.end, quantity: displacement}, motor: {joint: hinge, quantity: moment}, w: {at: rod.end, quantity: angular_velocity}}
)yaml"),
                            Formulation::vm_md);
    const auto exact = [&](double t) {
      return ref * (1 - std::exp(-zeta * omega * t) * (std::cos(od * t) + zeta * omega / od * std::sin(od * t)));
    };
    double worst = 0, work = 0, power = 0;
    for (std::size_t i = 0; i < at.t.size(); ++i) {
      const double phi = exact(at.t[i]);
      const Eigen::Vector3d flat(std::cos(phi) - 1, std::sin(phi), 0);
      const Eigen::Vector3d u = space ? Eigen::Vector3d(rotation.Q.transpose() * vector_at(at, "rod", i))
                                      : Eigen::Vector3d(at["rod.x"][i], at["rod.y"][i], 0);
      worst = std::max(worst, (u - flat).norm());
      const double now = space ? vector_at(at, "motor", i).dot(vector_at(at, "w", i)) : at["motor.z"][i] * at["w.z"][i];
      if (i > 0) work += 0.5 * (at.t[i] - at.t[i - 1]) * (now + power);
      power = now;
    }
    CHECK(worst < 1e-5);
    CHECK(work == Approx(at.energy.back().kinetic).epsilon(5e-4));
    CHECK(at.energy.back().elastic == 0);
  }
}

// The same spring twice: floe's own, and a load of the same stiffness and viscosity on the length of a spring without
// any. Between a beam that bends and the ground, in every formulation.
TEST_CASE("state loads: a spring by a formula is floe's own spring") {
  const std::string plane = R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 6}}
    section: {EA: 1e4, EI: 1, rhoA: 1}
joints:
  hinge: {type: revolute, between: [ground, beam.start]}
  spring: {type: spring, between: [beam.end, {body: ground, node: [1.2, 0.8]}], stiffness: $k, viscosity: $d, length: 0.5}
$load
gravity: [0, -9.81]
motion: {end: 0.4, step: 2e-3}
probes: {tip: {at: beam.end}, force: {joint: spring}}
)yaml",
                    space = R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: 4}}
    section: {shape: rectangle, width: 0.02, height: 0.01, orientation: [0, 1, 0]}
    material: {E: 7e9, nu: 0.3, rho: 2700}
joints:
  root: {type: fixed, between: [ground, beam.start]}
  spring: {type: spring, between: [beam.end, {body: ground, node: [1.2, 0.8, 0.3]}], stiffness: $k, viscosity: $d, length: 0.5}
$load
gravity: [0, 0, -9.81]
motion: {end: 0.1, step: 5e-4}
probes: {tip: {at: beam.end}, force: {joint: spring}}
)yaml";
  const std::string load =
      "loads: {pull: {type: force, joint: spring, force: \"-30*(spring.length - 0.5) - 0.4*spring.length_rate\"}}";
  for (const std::string& scene : {plane, space})
    for (const Formulation formulation : {Formulation::vm_md, Formulation::nlffr, Formulation::cfr}) {
      const History own = move(fill(scene, {{"k", "30"}, {"d", "0.4"}, {"load", ""}}), formulation),
                    formula = move(fill(scene, {{"k", "0"}, {"d", "0"}, {"load", load}}), formulation);
      for (const std::string column : {"tip.x", "tip.y", "force.x", "force.y"})
        CHECK(relative_error(formula, own, column) < 1e-6);
      CHECK(formula.report.newton <= own.report.newton + 2);
    }
}

// x.. = (1 - x^2) x. - x: amplitude 2.008619861, period 6.663286859 of the limit cycle (Andersen & Geer, SIAM J. Appl.
// Math. 42, 1982; Amore, Boyd & Fernandez 2018).
// I phi'' = -(k + k) phi: phi = w/2 sin 2t, with 3.5 and 35 rad a step. Torsional spring, load and probe count alike.
TEST_CASE("state loads: a rotor that rotates by several revolutions within a step") {
  for (const double w : {3500., 35000.}) {
    const auto columns = move(fill(R"yaml(
bodies: {a: {rigid: {mass: 1, centre: [0, 0, 0], inertia: [.1, .1, .1]}, initial: {angular_velocity: [0, 0, $w]}}}
joints:
  d: {type: revolute, between: [ground, a.centre], axis: [0, 0, 1]}
  k: {type: spring, between: [ground, a.centre], axis: [0, 0, 1], torsional_stiffness: .2}
loads: {m: {type: moment, joint: d, moment: -.2*d.angle}}
motion: {end: 1, step: 1e-3}
probes: {angle: {joint: d, quantity: angle}, M: {joint: k, quantity: moment}}
)yaml",
                                   {{"w", fmt::format("{}", w)}}),
                              Formulation::vm_md);
    CHECK(columns["angle.value"].back() == Approx(w / 2 * std::sin(2.)).epsilon(1e-5));
    CHECK(columns["M.z"].back() == Approx(-0.1 * w * std::sin(2.)).epsilon(1e-5));
  }
}

TEST_CASE("state loads: the limit cycle of van der Pol's oscillator has its amplitude and period") {
  const History at = move(R"yaml(
bodies:
  mass: {rigid: true, mesh: {line: {from: [0, 0], to: [1, 0], elements: 1}}, section: {EA: 1, EI: 1, rhoA: 1}}
joints: {slide: {type: prismatic, between: [ground, mass.start], axis: [0.6, 0.8]}}
loads: {law: {type: force, joint: slide, force: "(1 - (slide.travel + 1)^2)*slide.speed - slide.travel - 1"}}
motion: {end: 60, step: 5e-3, spectral_radius: 0.99}
probes: {mass: {at: mass.start}}
)yaml",
                          Formulation::vm_md);
  std::vector<double> x;
  for (std::size_t i = 0; i < at.t.size(); ++i) x.push_back(0.6 * at["mass.x"][i] + 0.8 * at["mass.y"][i] + 1);
  std::vector<double> up;
  double amplitude = 0;
  for (std::size_t i = 1; i < x.size(); ++i) {
    if (x[i - 1] < 0 && x[i] >= 0) up.push_back(at.t[i - 1] + (at.t[i] - at.t[i - 1]) * x[i - 1] / (x[i - 1] - x[i]));
    if (at.t[i] > 45) amplitude = std::max(amplitude, x[i]);
  }
  REQUIRE(up.size() > 4);
  CHECK(up.back() - up[up.size() - 2] == Approx(6.663286859).epsilon(2e-5));
  CHECK(amplitude == Approx(2.008619861).epsilon(2e-5));
}

// x.. + x + x^3 = 0 from rest at A: T = 4 K(m) / sqrt(1 + A^2), m = A^2 / (2 (1 + A^2)).
TEST_CASE("state loads: the period of Duffing's oscillator is that of the elliptic integral") {
  const History at = move(R"yaml(
bodies:
  mass:
    rigid: true
    mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: 1}}
    section: {shape: rectangle, width: 0.1, height: 0.1, orientation: [0, 1, 0]}
    material: {E: 1, nu: 0.3, rho: 100}
    initial: {position: [2, 0, 0]}
joints: {slide: {type: prismatic, between: [ground, mass.start], axis: [1, 0, 0]}}
loads: {law: {type: force, at: mass.start, force: ["-mass.x - mass.x^3", 0, 0]}}
motion: {end: 10, step: 2e-3, spectral_radius: 0.99}
probes: {mass: {at: mass.start, quantity: position}}
)yaml",
                          Formulation::vm_md);
  const double A = 2, T = 4 * std::comp_ellint_1(A / std::sqrt(2 * (1 + A * A))) / std::sqrt(1 + A * A);
  const auto zeros = at.crossings("mass.x");
  REQUIRE(zeros.size() > 4);
  CHECK(zeros[4] - zeros[0] == Approx(2 * T).epsilon(2e-5));
  CHECK(at.energy.back().kinetic > 0);
}

// A free body in a fluid: m v. = -c v, J w. = -b w about an axis of the body.
TEST_CASE("state loads: forces opposed to velocities damp the motion") {
  const History at = move(R"yaml(
bodies:
  ball:
    rigid: true
    mesh: {line: {from: [-0.5, 0, 0], to: [0.5, 0, 0], elements: 2}}
    section: {shape: rectangle, width: 1, height: 1, orientation: [0, 1, 0]}
    material: {E: 1, nu: 0.3, rho: 6}
    initial: {velocity: [1, 2, 3], angular_velocity: [0, 0, 4]}
loads:
  drag: {type: force, at: ball.middle, force: ["-12*v.x", "-12*v.y", "-12*v.z"]}
  torque: {type: moment, at: ball.middle, axes: place, moment: [0, 0, "-0.5*w.z"]}
motion: {end: 1, step: 1e-3}
probes: {v: {at: ball.middle, quantity: velocity}, w: {at: ball.middle, quantity: angular_velocity}}
)yaml",
                          Formulation::vm_md);
  CHECK(at["v.y"].back() == Approx(2 * std::exp(-2)).epsilon(1e-5));
  CHECK(at["v.z"].back() == Approx(3 * std::exp(-2)).epsilon(1e-5));
  CHECK(at["w.z"].back() == Approx(4 * std::exp(-0.5)).epsilon(1e-5));  // J = m/6 = 1
}

// A rod on a flap hinge at the axis of a hub that rotates with W: flap omega^2 = W^2 + k/I, and with a damper d the
// exponent -d/(2I) +- i sqrt(W^2 + k/I - (d/2I)^2).
TEST_CASE("state loads: frequencies and damping at steady rotation contain the loads' derivatives") {
  const std::string scene = R"yaml(
bodies:
  hub:
    rigid: true
    mesh: {line: {from: [0, 0, -0.5], to: [0, 0, 0], elements: 1}}
    section: {shape: rectangle, width: 0.1, height: 0.1, orientation: [1, 0, 0]}
    material: {E: 1, nu: 0.3, rho: 1}
  rod:
    rigid: true
    mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: 2}}
    section: {shape: rectangle, width: 1e-4, height: 1e-4, orientation: [0, 1, 0]}
    material: {E: 1, nu: 0.3, rho: 3e8}
joints:
  shaft: {type: driven, between: [ground, hub.start], axis: [0, 0, 1], angle: "2*t"}
  flap: {type: revolute, between: [hub.end, rod.start], axis: [0, 1, 0]}
loads: {flap: {type: moment, joint: flap, moment: "-5*sin(flap.angle) - 0.8*flap.rate"}}
)yaml";
  app::CampbellRequest request;
  request.speeds = "3", request.modes = 1;
  std::exception_ptr fault;
  const app::CampbellDiagram found =
      app::campbell(scene::parse_scene(scene, "scene"), Formulation::vm_md, PETSC_COMM_WORLD, request, fault);
  if (fault) std::rethrow_exception(fault);
  REQUIRE(found.points.size() == 1);
  REQUIRE(found.points[0].fault == "");
  CHECK(found.points[0].vibrations[0].growth == Approx(-0.4).epsilon(1e-6));
  CHECK(found.points[0].vibrations[0].omega == Approx(std::sqrt(9 + 5 - 0.16)).epsilon(1e-6));
}

// k phi = m g l / 2 cos phi, reached by Newton's method.
TEST_CASE("state loads: an equilibrium with a nonlinear spring") {
  const History at = rest(rod(false, R"yaml(
gravity: [0, -9.81]
loads: {spring: {type: moment, joint: hinge, moment: "-40*hinge.angle - 200*hinge.angle^3"}}
probes: {rod: {at: rod.end, quantity: rotation}}
)yaml"),
                          Formulation::vm_md);
  const double phi = at["rod.angle"][0];
  CHECK(phi < -0.1);
  CHECK(-40 * phi - 200 * phi * phi * phi == Approx(3 * 9.81 / 2 * std::cos(phi)).epsilon(1e-9));
}

// A mass with speed v comes to rest after m v^2 / (2 f); an oscillator of stiffness k loses 2 f / k of its amplitude in
// every half period, however fast it moves.
TEST_CASE("friction: a slider comes to rest, and an oscillator decays by equal steps") {
  const History slider = move(R"yaml(
bodies:
  mass:
    rigid: true
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 1}}
    section: {EA: 1, EI: 1, rhoA: 2}
    initial: {velocity: [3, 0]}
joints: {slide: {type: prismatic, between: [ground, mass.start], friction: {level: 5, speed: 1e-3}}}
motion: {end: 1.5, step: 1e-3}
probes: {mass: {at: mass.start}, force: {joint: slide}}
)yaml",
                              Formulation::vm_md);
  CHECK(slider["mass.x"].back() == Approx(2 * 9. / (2 * 5)).epsilon(1e-3));
  CHECK(slider.at("force.x", 0.6) == Approx(-5).epsilon(1e-6));
  const double k = 100, f = 2;
  for (const bool space : {false, true}) {
    std::string text = rod(space, R"yaml(
loads: {spring: {type: moment, joint: hinge, moment: "-100*(hinge.angle + 0.5)"}}
motion: {end: 2, step: 1e-3}
probes: {angle: {at: rod.end, quantity: rotation}}
)yaml");
    text.replace(text.find("revolute,"), 9, "revolute, friction: {level: 2, speed: 1e-3},");
    const History at = move(text, Formulation::vm_md);
    std::vector<double> x, peaks;
    for (std::size_t i = 0; i < at.t.size(); ++i) {
      const double phi =
          !space
              ? at["angle.angle"][i]
              : (rotation.Q.transpose() * Eigen::Vector3d(at["angle.rx"][i], at["angle.ry"][i], at["angle.rz"][i])).z();
      x.push_back(phi + 0.5);
    }
    for (std::size_t i = 1; i + 1 < x.size(); ++i)
      if ((x[i] - x[i - 1]) * (x[i + 1] - x[i]) < 0) peaks.push_back(std::abs(x[i]));
    REQUIRE(peaks.size() >= 5);
    for (int n = 0; n < 5; ++n) CHECK(peaks[n] == Approx(0.5 - 2 * f / k * (n + 1)).margin(2e-4));
  }
}

// I w. = -M until the release, then w is constant: friction, stops and loads of a joint end with its constraints.
TEST_CASE("state loads: a joint that is released exerts no friction, no load, and has no stops") {
  for (const bool space : {false, true}) {
    INFO("in space " << space);
    std::string text = rod(space, R"yaml(
loads: {motor: {type: moment, joint: hinge, moment: "-1 - 0*hinge.angle"}}
events: {drop: {unlock: hinge, at: 0.1}}
motion: {end: 0.5, step: 1e-3}
probes: {w: {at: rod.end, quantity: angular_velocity}}
)yaml");
    const std::string plain = space ? fill("axis: $z}", {{"z", rotation(0, 0, 1)}}) : "[ground, rod.start]}";
    const auto at = text.find(plain);
    REQUIRE(at != std::string::npos);
    text.insert(at + plain.size() - 1, ", friction: {level: 4, speed: 1e-3}, limits: {upper: 0.6, stiffness: 1e4}");
    const std::string shape = space ? "rotation: " + rotation.text() : "rhoI: 0}";
    const auto body = text.find(shape);
    REQUIRE(body != std::string::npos);
    text.insert(body + shape.size(), space ? fill(", angular_velocity: $w", {{"w", rotation(0, 0, 4)}})
                                           : "\n    initial: {angular_velocity: 4}");
    const History history = move(text, Formulation::vm_md);
    double w = 0;
    if (space)
      w = (rotation.Q.transpose() * vector_at(history, "w", history.t.size() - 1)).z();
    else
      w = history["w.z"].back();
    CHECK(w == Approx(4 - 5 * 0.1).epsilon(1e-6));  // 1.77 rad beyond the start: a stop would have thrown it back
  }
}

// q = q0 - c w at the tip of a cantilever: w = w0 / (1 + c w0 / q0), w0 = q0 L^4 / (8 EI), in the plane and in space;
// the moment at the root is that of the reaction.
TEST_CASE("state loads: a distributed load that follows the tip of a cantilever") {
  const std::string plane = R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 20}}
    section: {EA: 1e6, EI: 50, rhoA: 1}
    frame: {type: clamped, at: start}
    reduction: {modes: 6, attachment: all}
joints: {root: {type: fixed, between: [ground, beam.start]}}
loads: {q: {type: distributed, body: beam, force: [0, "4e-3*t - 300*tip.y"]}}
probes: {tip: {at: beam.end}, m: {joint: root, quantity: moment}, section: {at: beam.start, quantity: section_moment}}
)yaml",
                    space = R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: 20}}
    section: {shape: rectangle, width: 0.01, height: 0.01, orientation: [0, 1, 0]}
    material: {E: 6e10, nu: 0.3, rho: 1000}
    frame: {type: clamped, at: start}
    reduction: {modes: 8, attachment: all}
joints: {root: {type: fixed, between: [ground, beam.start]}}
loads: {q: {type: distributed, body: beam, force: [0, 0, "4e-3*t - 300*tip.z"]}}
probes: {tip: {at: beam.end}, m: {joint: root, quantity: moment}, section: {at: beam.start, quantity: section_moment}}
)yaml";
  const double w0 = 4e-3 / (8 * 50), w = w0 / (1 + 300 * w0 / 4e-3), q = 4e-3 - 300 * w;
  for (const bool spatial : {false, true})
    for (const Formulation formulation : {Formulation::vm_md, Formulation::nlffr, Formulation::cfr}) {
      INFO(spatial << " " << scene::name_of(formulation));
      const History at = rest(spatial ? space : plane, formulation);
      const double lumped = formulation == Formulation::cfr ? 5e-3 : 1e-4;  // loads at nodes
      CHECK(at[spatial ? "tip.z" : "tip.y"][0] == Approx(w).epsilon(lumped));
      const double m = std::abs(at[spatial ? "m.y" : "m.z"][0]);
      CHECK(m == Approx(q / 2).epsilon(5e-3));
      const double section = std::abs(at[spatial ? "section.My" : "section.M"][0]);
      if (formulation != Formulation::cfr) CHECK(section == Approx(m).epsilon(1e-6));
    }
}

// A pressure p0 - c w of a clamped strip: w = w0 / (1 + c w0 / p0), w0 of the pressure p0 alone; follower and dead.
TEST_CASE("state loads: a pressure that follows the edge of a strip of shells, in every formulation") {
  const std::string text = R"yaml(
bodies:
  strip:
    mesh: {plate: {along: [1, 0, 0], across: [0, 0.25, 0], elements: [8, 2], cells: quadrilaterals}}
    section: {thickness: 0.01}
    material: {E: 1e9, nu: 0.3, rho: 1000}
    reduction: {modes: $n, attachment: all}
joints: {root: {type: fixed, between: [ground, strip.left]}}
loads: {p: {type: pressure, body: strip, pressure: "$p", follower: $follower}}
motion: {end: 2, step: 1e-2}
probes: {tip: {at: strip.right}, v: {at: strip.right, quantity: velocity}}
)yaml";
  for (const char* follower : {"true", "false"})
    for (const Formulation formulation : {Formulation::vm_md, Formulation::nlffr, Formulation::cfr}) {
      INFO(follower << " " << scene::name_of(formulation));
      const auto loaded = [&](const char* p) {
        return rest(fill(text, {{"n", "6"}, {"p", p}, {"follower", follower}}), formulation)["tip.z"][0];
      };
      const double w0 = loaded("1e-2*t");
      CHECK(loaded("1e-2*t - 200*tip.z") == Approx(w0 / (1 + 200 * w0 / 1e-2)).epsilon(1e-6));
    }
  // a pressure against the velocity of the edge damps the first mode (it excites the second, whose mean moves against
  // its edge): the strip passes its equilibrium and comes to rest there
  std::string one = text;
  one.replace(one.find("attachment: all"), 15, "attachment: none, derivatives: none");
  const auto pushed = [&](const char* p) { return fill(one, {{"n", "1"}, {"p", p}, {"follower", "true"}}); };
  const History at = move(pushed("1e-2 - 30*v.z"), Formulation::vm_md);
  const double w = rest(pushed("1e-2*t"), Formulation::vm_md)["tip.z"][0];
  CHECK(at["tip.z"].back() == Approx(w).epsilon(0.02));
  CHECK(*std::max_element(at["tip.z"].begin(), at["tip.z"].end()) > 1.2 * w);
}

TEST_CASE("state loads: drives refuse sensors, and name the alternative") {
  try {
    scene::parse_scene(R"yaml(
bodies: {rod: {rigid: {mass: 1, centre: [0, 0], inertia: 1}}}
joints: {motor: {type: driven, between: [ground, rod.centre], angle: "2*motor.rate"}}
)yaml",
                       "scene");
    FAIL("no error");
  } catch (const InputError& error) {
    CHECK_THAT(error.what(), Catch::Contains("joints.motor.angle: depends on a sensor"));
    CHECK_THAT(error.what(), Catch::Contains("a load on it that follows the sensor"));
  }
}

// A step that changes begins with consistent accelerations; of motions that hinges damp much faster than the step they
// contain what the velocities are off, which must not grow. The steps were 5099, the rate of the elbow 44 rad/s.
TEST_CASE("state loads: adaptive steps of two links with strongly damped joints are the motion of fixed ones") {
  const std::string arm = R"yaml(
functions: {ref: "0.9*smooth(t, 0, 0.5)"}
gravity: [0, "-9.81*smooth(t, 0, 0.3)"]
bodies:
  upper:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 6}}
    section: {A: 2.24e-4, I: 2.94e-8}
    material: {E: 7e9, rho: 2700}
    reduction: {modes: 3}
  fore:
    mesh: {line: {from: [1, 0], to: [1.8, 0], elements: 6}}
    section: {A: 2.24e-4, I: 2.94e-8}
    material: {E: 7e9, rho: 2700}
    reduction: {modes: 3}
  payload: {rigid: {mass: 1.5, centre: [1.85, 0.03], inertia: 5e-3}}
joints:
  shoulder: {type: revolute, between: [ground, upper.start]}
  elbow: {type: revolute, between: [upper.end, fore.start]}
  grip: {type: fixed, between: [fore.end, {body: payload, node: [1.8, 0]}]}
loads:
  sm: {type: moment, joint: shoulder, moment: "-400*(shoulder.angle - ref(t)) - 30*shoulder.rate"}
  em: {type: moment, joint: elbow, moment: "-150*(elbow.angle + ref(t)) - $d*elbow.rate"}
motion: {end: 0.1, step: 1e-3$tolerance}
probes:
  rate: {joint: elbow, quantity: rate}
  payload: {at: payload.centre, quantity: position}
)yaml";
  const std::string damping = GENERATE("0", "8");
  const Formulation formulation = GENERATE(Formulation::vm_md, Formulation::nlffr, Formulation::cfr);
  INFO(damping << " " << name_of(formulation));
  const auto moved = [&](const char* tolerance) {
    return move(fill(arm, {{"d", damping}, {"tolerance", tolerance}}), formulation);
  };
  const History fixed = moved(""), adaptive = moved(", tolerance: 1e-4");
  const auto greatest = [](const History& at) {
    double most = 0;
    for (const double rate : at["rate.value"]) most = std::max(most, std::abs(rate));
    return most;
  };
  CHECK(adaptive.report.steps < 1000);
  CHECK(greatest(adaptive) == Approx(greatest(fixed)).epsilon(0.01));
  CHECK(adaptive["payload.y"].back() == Approx(fixed["payload.y"].back()).epsilon(1e-4));
}

// Steps that are long for the damped modes of the outer link: what they do not resolve must not reach constraints. The
// force at the hub was 8e4 N for 84 N, the tip 0.09 m off, without a warning.
TEST_CASE("state loads: an arm with a damped elbow and damped modes takes loose tolerances") {
  const std::string arm = R"yaml(
gravity: [0, -9.81]
bodies:
  inner:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 8}}
    section: {A: 4e-4, I: 1.333e-8}
    material: {E: 7e10, rho: 2700}
    frame: clamped
    reduction: {modes: 4}
  outer: {like: inner, damping: {stiffness: 1e-3}, initial: {position: [1, 0]}}
joints:
  hub: {type: revolute, between: [ground, inner.start]}
  elbow: {type: revolute, between: [inner.end, outer.start]}
  spring: {type: spring, between: [inner.end, outer.start], torsional_stiffness: 20, torsional_viscosity: 50}
loads: {m: {type: moment, joint: hub, moment: "-200*(hub.angle - 0.8*smooth(t, 0, 0.3)) - 5*hub.rate"}}
motion: {end: 0.6, $steps}
probes:
  tip: {at: inner.end, quantity: position}
  F: {joint: hub, quantity: force}
)yaml";
  const auto greatest = [](const History& at) {
    double most = 0;
    for (std::size_t i = 0; i < at.t.size(); ++i) most = std::max(most, std::hypot(at["F.x"][i], at["F.y"][i]));
    return most;
  };
  const History fixed = move(fill(arm, {{"steps", "step: 5e-4"}}), Formulation::vm_md);
  for (const std::string tolerance : {"1e-2", "5e-3", "2e-3", "1e-3"}) {
    const History at = move(fill(arm, {{"steps", "step: 6e-4, tolerance: " + tolerance}}), Formulation::vm_md);
    INFO(tolerance);
    CHECK(at.report.steps < 200);
    CHECK(greatest(at) < 2 * greatest(fixed));
    CHECK(at["tip.y"].back() == Approx(fixed["tip.y"].back()).margin(0.02));
  }
}
