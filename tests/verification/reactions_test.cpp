// Forces and moments of joints, as probes: closed forms, the equilibrium of free bodies, and every formulation.
#include <catch2/catch.hpp>

#include "building.h"
#include "floe/math/rotation.h"
#include "scene_motion.h"

using namespace floe;
using namespace floe::test;
using Catch::Matchers::Contains;

namespace {

constexpr double g = 9.81;

Eigen::Vector3d last(const History& history, const std::string& probe) {
  return {history[probe + ".x"].back(), history[probe + ".y"].back(), history[probe + ".z"].back()};
}

/// A clamped beam in space: weight, and forces at its end.
const char* clamped_beam = R"yaml(
gravity: [0, 0, -9.81]
bodies:
  beam:
    mesh: {line: {from: [0, 0, 0], to: [2, 0, 0], elements: 12}}
    section: {shape: rectangle, width: 0.05, height: 0.02, orientation: [0, 1, 0]}
    material: {E: 7e10, nu: 0.3, rho: 2700}
    frame: $frame
    reduction: {modes: 4}
joints:
  clamp: {type: fixed, between: $between}
loads:
  tip: {type: force, at: beam.end, force: [3, 2, 5]}
motion: {end: 0.1, step: 1e-3}
probes:
  f: {joint: clamp}
  m: {joint: clamp, quantity: moment}
  middle: {at: beam.middle}
  tip: {at: beam.end}
)yaml";

}  // namespace

TEST_CASE("reaction of a pendulum's hinge: r = m (a - g)", "[verification]") {
  const std::string text = R"yaml(
gravity: [0, -9.81]
bodies:
  rod:
    rigid: true
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 4}}
    section: {rhoA: 2}
joints:
  hinge: {type: revolute, between: [ground, rod.start]}
motion: {end: 1, step: 0.001}
probes:
  r: {joint: hinge}
  m: {joint: hinge, quantity: moment}
  along: {joint: hinge, relative_to: rod.end}
  angle: {at: rod.end, quantity: rotation}
  speed: {at: rod.end, quantity: angular_velocity}
)yaml";
  const History history = move(text, Formulation::vm_md);
  for (std::size_t i = 0; i < history.t.size(); i += 50) {
    const double angle = history["angle.angle"][i], w = history["speed.z"][i], c = std::cos(angle), s = std::sin(angle);
    const double rate = -1.5 * g * c;
    const Eigen::Vector2d a(0.5 * (-w * w * c - rate * s), 0.5 * (-w * w * s + rate * c));
    const Eigen::Vector2d r(2 * a.x(), 2 * (a.y() + g));
    INFO("t = " << history.t[i]);
    CHECK(std::abs(history["r.x"][i] - r.x()) < 1e-9 * 50);
    CHECK(std::abs(history["r.y"][i] - r.y()) < 1e-9 * 50);
    CHECK(history["m.z"][i] == 0);
    CHECK(history["along.x"][i] == Approx(c * r.x() + s * r.y()).margin(1e-7));
    CHECK(history["along.y"][i] == Approx(-s * r.x() + c * r.y()).margin(1e-7));
  }
}

TEST_CASE("a mass on two rods from two points of the ground: the tension m g / (2 cos 45)", "[verification]") {
  const History history = move(R"yaml(
gravity: [0, 0, -9.81]
bodies: {b: {rigid: {mass: 2, centre: [0, 0, 0], inertia: [1, 1, 1]}}}
joints:
  left: {type: distance, between: [{body: ground, node: [-1, 0, 1]}, b.centre]}
  right: {type: distance, between: [b.centre, {body: ground, node: [1, 0, 1]}]}
motion: {end: 0.1, step: 1e-3}
probes: {p: {at: b.centre}, f: {joint: left}}
)yaml",
                               Formulation::vm_md);
  CHECK(std::abs(history["p.x"].back()) < 1e-12);
  CHECK(std::abs(history["p.z"].back()) < 1e-12);
  CHECK(history["f.x"].back() == Approx(-g).epsilon(1e-9));
  CHECK(history["f.z"].back() == Approx(g).epsilon(1e-9));
}

TEST_CASE("reaction of a clamp balances weight and loads in every formulation and frame", "[verification]") {
  const double m = 0.05 * 0.02 * 2 * 2700;
  for (const char* frame : {"{type: clamped, at: start}", "{type: pinned, from: start, to: end}", "{type: mean-axis}"})
    for (const char* between : {"[ground, beam.start]", "[beam.start, ground]"})
      for (const auto formulation : {Formulation::vm_md, Formulation::nlffr, Formulation::cfr}) {
        INFO(frame << " " << between << " " << scene::name_of(formulation));
        const double sign = between[1] == 'g' ? 1 : -1;  // on the beam, or on the ground
        const History at = rest(fill(clamped_beam, {{"frame", frame}, {"between", between}}), formulation);
        const Eigen::Vector3d f(3, 2, 5), weight(0, 0, -m * g);
        CHECK((sign * last(at, "f") + f + weight).norm() < 1e-8);
        // about the clamp, at the deformed places; the weight acts near the middle, as the bending line has it
        const Eigen::Vector3d end = Eigen::Vector3d(2, 0, 0) + last(at, "tip");
        const Eigen::Vector3d moment = sign * last(at, "m") + end.cross(f) + Eigen::Vector3d(1, 0, 0).cross(weight);
        CHECK(moment.norm() < 0.01 * last(at, "m").norm());
        CHECK(std::abs(moment.y()) < 5e-4 * last(at, "m").norm());
      }
}

TEST_CASE("a measured clamp changes nothing but that it is measured", "[verification]") {
  std::string text = fill(clamped_beam, {{"frame", "{type: clamped, at: start}"}, {"between", "[ground, beam.start]"}});
  const std::string unmeasured =
      fill(text, {}).replace(text.find("  f: {joint"), text.find("  middle:") - text.find("  f: {joint"), "");
  for (const auto formulation : {Formulation::vm_md, Formulation::nlffr}) {
    INFO(scene::name_of(formulation));
    const History with = move(text, formulation), without = move(unmeasured, formulation);
    CHECK(with.model.multipliers == without.model.multipliers + 6);
    for (const char* column : {"tip.x", "tip.y", "tip.z"}) CHECK(relative_error(with, without, column) < 1e-6);
  }
}

TEST_CASE("drive moment and root reactions of a beam on a driven hub", "[verification]") {
  // hub and beam rigid enough; angle a t^2/2 gives f = m r (-w^2, a), moments about the places
  const std::string text = R"yaml(
bodies:
  hub:
    rigid: true
    mesh: {line: {from: [-0.1, 0, 0], to: [0.1, 0, 0], elements: 2}}
    section: {shape: rectangle, width: 0.05, height: 0.05, orientation: [0, 1, 0]}
    material: {E: 7e10, nu: 0.3, rho: 2700}
  beam:
    $rigid
    mesh: {line: {from: [0.1, 0, 0], to: [1.1, 0, 0], elements: 12}}
    section: {shape: rectangle, width: 0.05, height: 0.02, orientation: [0, 1, 0]}
    material: {E: 7e10, nu: 0.3, rho: 2700}
joints:
  drive: {type: driven, between: [ground, {body: hub, node: [0, 0, 0]}], axis: [0, 0, 1], angle: "2*t^2"}
  root: {type: fixed, between: [hub.end, beam.start]}
motion: {end: 1, step: 0.005}
probes:
  f: {joint: root, relative_to: hub.end}
  m: {joint: root, quantity: moment}
  drive: {joint: drive, quantity: moment}
  omega: {at: hub.end, quantity: angular_velocity}
)yaml";
  const double mu = 2.7, w = 4, a = 4, r = 0.6, section = 0.05 * 0.02 * 0.05 * 0.05 / 12 * 2700;
  const double beam = mu * (std::pow(1.1, 3) - std::pow(0.1, 3)) / 3 + section;
  const double hub = 6.75 * 0.2 * 0.2 * 0.2 / 12 + 6.75 * 0.2 * 0.05 * 0.05 / 12;
  const double root = mu * (1. / 3 + 0.1 / 2) + section;
  const History rigid = move(fill(text, {{"rigid", "rigid: true"}}), Formulation::vm_md);
  CHECK((last(rigid, "f") - Eigen::Vector3d(-mu * r * w * w, mu * r * a, 0)).norm() < 1e-4);
  CHECK((last(rigid, "m") - Eigen::Vector3d(0, 0, root * a)).norm() < 1e-4);
  CHECK((last(rigid, "drive") - Eigen::Vector3d(0, 0, (beam + hub) * a)).norm() < 1e-4);
  CHECK((last(rigid, "omega") - Eigen::Vector3d(0, 0, w)).norm() < 1e-6);
  // flexible: the beam swings about that, which the centripetal force hardly notices
  const std::string bent = fill(text, {{"rigid", "frame: {type: clamped, at: start}\n    reduction: {modes: 4}"}});
  const History reduced = move(bent, Formulation::vm_md), full = move(bent, Formulation::cfr);
  CHECK(reduced["f.x"].back() == Approx(-mu * r * w * w).epsilon(0.02));
  CHECK(full["f.x"].back() == Approx(reduced["f.x"].back()).epsilon(0.02));
}

TEST_CASE("springs, bushings and end stops report their forces", "[verification]") {
  const std::string text = R"yaml(
gravity: [0, 0, -10]
bodies:
  mass:
    rigid: true
    mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: 2}}
    section: {shape: rectangle, width: 0.1, height: 0.1, orientation: [0, 1, 0]}
    material: {E: 7e10, nu: 0.3, rho: 100}
joints: $joints
motion: {end: 1, step: 0.01}
probes:
  f: {joint: $probe}
  m: {joint: $probe, quantity: moment}
)yaml";
  const double weight = 10;  // 1 kg
  const auto at_rest = [&](const std::string& joints, const std::string& probe) {
    return rest(fill(text, {{"joints", joints}, {"probe", probe}}), Formulation::vm_md);
  };
  const History bushing = at_rest(
      "{b: {type: bushing, between: [ground, mass.start], translation: [1e5, 1e5, 1e5], rotation: [1e5, 1e5, 1e5]}}",
      "b");
  CHECK((last(bushing, "f") - Eigen::Vector3d(0, 0, weight)).norm() < 1e-9);
  CHECK((last(bushing, "m") - Eigen::Vector3d(0, -weight / 2, 0)).norm() < 1e-6);
  const std::string slide =
      "{guide: {type: prismatic, between: [ground, mass.start], axis: [0, 0, 1]$limits}, spring: {type: spring, "
      "between: "
      "[{body: ground, node: [0, 0, 2]}, mass.start], stiffness: $k}}";
  const History spring = at_rest(fill(slide, {{"k", "100"}, {"limits", ""}}), "spring");
  CHECK((last(spring, "f") - Eigen::Vector3d(0, 0, weight)).norm() < 1e-9);
  const History guide = at_rest(fill(slide, {{"k", "100"}, {"limits", ""}}), "guide");
  CHECK(last(guide, "f").norm() < 1e-9);
  CHECK((last(guide, "m") - Eigen::Vector3d(0, -weight / 2, 0)).norm() < 1e-9);
  // the stop holds what the spring does not: 100 N/m over 0.01 m and what the stop gives way
  const History stopped = at_rest(
      fill(slide, {{"k", "100"}, {"limits", ", limits: {lower: -0.01, stiffness: 1e6, width: 1e-6}"}}), "guide");
  CHECK(last(stopped, "f").z() == Approx(weight - 1).epsilon(1e-3));
}

TEST_CASE("a plate's edges carry its weight", "[verification]") {
  const std::string text = R"yaml(
gravity: [0, 0, -9.81]
bodies:
  plate:
    mesh: {plate: {origin: [0, 0, 0], along: [2, 0, 0], across: [0, 1, 0], elements: [8, 4]}}
    section: {thickness: 0.02}
    material: {E: 7e10, nu: 0.3, rho: 2700}
    reduction: {modes: 3}
joints:
  edge: {type: $type, between: [ground, plate.left]}
motion: {end: 0.01, step: 1e-3}
probes:
  f: {joint: edge}
  m: {joint: edge, quantity: moment}
)yaml";
  const double weight = 2 * 0.02 * 2700 * g;
  for (const auto formulation : {Formulation::vm_md, Formulation::nlffr, Formulation::cfr}) {
    INFO(scene::name_of(formulation));
    const History at = rest(fill(text, {{"type", "fixed"}}), formulation);
    CHECK((last(at, "f") - Eigen::Vector3d(0, 0, weight)).norm() < 1e-6 * weight);
    CHECK((last(at, "m") - Eigen::Vector3d(0, -weight, 0)).norm() < 2e-3 * weight);
  }
}

TEST_CASE("supports that the equilibrium does not determine", "[verification]") {
  // q L^4 / (E I): clamped and simply supported, 5/8 and 3/8 of the load, moment q L^2 / 8
  const std::string text = R"yaml(
gravity: [0, -10]
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 16}}
    section: {EA: 1e6, EI: 1e3, rhoA: 1}
    frame: {type: clamped, at: start}
    reduction: {modes: {count: 4, of: $of}}
joints:
  clamp: {type: fixed, between: [ground, beam.start]}
  support: {type: prismatic, between: [ground, slide.middle], axis: [1, 0]}
  pin: {type: revolute, between: [slide.middle, beam.end]}
motion: {end: 0.1, step: 1e-3}
probes:
  f: {joint: clamp}
  m: {joint: clamp, quantity: moment}
  p: {joint: pin}
)yaml";
  const std::string slide =
      "  slide: {rigid: true, mesh: {line: {from: [0.9, 0], to: [1.1, 0], elements: 2}}, section: {rhoA: "
      "1e-9}}\njoints:";
  std::string scene = text;
  scene.replace(scene.find("joints:"), 7, slide);
  for (const auto formulation : {Formulation::nlffr, Formulation::cfr, Formulation::vm_md}) {
    INFO(scene::name_of(formulation));
    const History at = rest(fill(scene, {{"of", "frame"}}), formulation);
    const double tolerance = formulation == Formulation::vm_md ? 0.02 : 1e-4;
    CHECK(at["f.y"].back() == Approx(6.25).epsilon(tolerance));
    CHECK(at["m.z"].back() == Approx(1.25).epsilon(tolerance));
    CHECK(at["p.y"].back() == Approx(3.75).epsilon(tolerance));
  }
}

TEST_CASE("a beam between two clamps: q L / 2, q L^2 / 12, or the refusal of a basis that does not determine them",
          "[verification]") {
  const std::string text = R"yaml(
gravity: [0, 0, -10]
bodies:
  beam:
    mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: 8}}
    section: {shape: rectangle, width: 0.05, height: 0.02, orientation: [0, 1, 0]}
    material: {E: 7e10, nu: 0.3, rho: 1000}
    frame: {type: clamped, at: start}
    reduction: {modes: {count: 4, of: joints}, attachment: $attachment}
joints:
  clamp: {type: fixed, between: [ground, beam.start]}
  end: {type: fixed, between: [ground, beam.end]}
motion: {end: 1, step: 0.1}
probes:
  f: {joint: $joint}
  m: {joint: $joint, quantity: moment}
)yaml";
  for (const char* joint : {"clamp", "end"}) {
    INFO(joint);
    const auto scene = [&](const char* attachment) {
      return fill(text, {{"joint", joint}, {"attachment", attachment}});
    };
    const History at = rest(scene("joints"), Formulation::vm_md);
    CHECK(last(at, "f").z() == Approx(5).epsilon(1e-6));
    CHECK(std::abs(last(at, "m").y()) == Approx(10. / 12).epsilon(1e-4));
    CHECK_THAT(testing::complaint(scene("none"), Formulation::vm_md),
               Contains(fmt::format("probes.f.joint: the reaction of joint {} is statically indeterminate", joint)));
    CHECK(testing::complaint(scene("none"), Formulation::nlffr).empty());
  }
}

TEST_CASE("a drive by a cubic table leaves no moment after it stops", "[verification]") {
  const std::string text = R"yaml(
functions:
  stroke: {t: [0, 0.1003, 0.2], values: [0, 0.1, 0.1], interpolation: cubic}
bodies:
  rod: {rigid: true, mesh: {line: {from: [0, 0], to: [1, 0], elements: 2}}, section: {rhoA: 1}}
joints:
  motor: {type: driven, between: [ground, rod.start], angle: stroke(t)}
motion: {end: 0.4, step: 0.01}
probes:
  m: {joint: motor, quantity: moment}
)yaml";
  const History history = move(text, Formulation::vm_md);
  double largest = 0;
  for (std::size_t i = 0; i < history.t.size(); ++i) {
    largest = std::max(largest, std::abs(history["m.z"][i]));
    if (history.t[i] > 0.105) CHECK(std::abs(history["m.z"][i]) < 1e-3);
  }
  CHECK(largest > 1);
}

// Driven by phi = 0.7 + 2 t^4 about its end, a rod of mass m and length 1 needs the force m r (-w^2, w.) along and
// across itself, r = 1/2, and the moment J w. about its end.
TEST_CASE("reactions in the axes of a joint: those of a rotating arm, oblique in its mesh, in every formulation",
          "[verification]") {
  const Eigen::Matrix3d Q = math::rotation(Eigen::Vector3d(0.4, -0.9, 0.7));
  const auto in_space = [&](double x, double y, double z) {
    const Eigen::Vector3d p = Q * Eigen::Vector3d(x, y, z);
    return fmt::format("[{:.17g}, {:.17g}, {:.17g}]", p.x(), p.y(), p.z());
  };
  const std::string plane = R"yaml(
bodies:
  arm:
    mesh: {line: {from: [0, 0], to: [0.6, 0.8], elements: 6}}
    section: {EA: 1e9, EI: 1e6, rhoA: 2}
    frame: $frame
    reduction: {modes: 4}
    initial: {angle: 0.7}
joints: {motor: {type: driven, between: $between, angle: "2*t^4"}}
motion: {end: 1, step: 2e-3}
probes:
  f: {joint: motor, axes: joint}
  m: {joint: motor, quantity: moment, axes: joint}
  w: {joint: motor}
  g: {joint: motor, axes: ground}
)yaml",
                    space = R"yaml(
bodies:
  arm:
    mesh: {line: {from: [0, 0, 0], to: [0.6, 0.8, 0], elements: 6}}
    section: {shape: rectangle, width: 0.02, height: 0.02, orientation: [0, 0, 1]}
    material: {E: 1e14, nu: 0.3, rho: 5000}
    frame: $frame
    reduction: {modes: 4}
    initial: {rotation: $r}
joints: {motor: {type: driven, between: $between, axis: $z, angle: "2*t^4"}}
motion: {end: 1, step: 2e-3}
probes:
  f: {joint: motor, axes: joint}
  m: {joint: motor, quantity: moment, axes: joint}
  w: {joint: motor}
  g: {joint: motor, axes: ground}
)yaml";
  for (const bool spatial : {false, true})
    for (const char* frame : {"{type: clamped, at: start}", "{type: pinned, from: start, to: end}"})
      for (const char* between : {"[ground, arm.start]", "[arm.start, ground]"})
        for (const auto formulation : {Formulation::vm_md, Formulation::nlffr, Formulation::cfr}) {
          INFO(spatial << " " << frame << " " << between << " " << scene::name_of(formulation));
          const bool turned = between[1] == 'a';  // the force on the ground, and the arm rotates backwards
          const Eigen::Vector3d r = math::rotation_vector(Eigen::Quaterniond(Q));
          const History at = move(
              fill(spatial ? space : plane, {{"frame", frame},
                                             {"between", between},
                                             {"r", fmt::format("[{:.17g}, {:.17g}, {:.17g}]", r.x(), r.y(), r.z())},
                                             {"z", in_space(0, 0, 1)}}),
              formulation);
          for (const double t : {0.5, 0.8, 1.}) {
            const auto i = static_cast<std::size_t>(std::lround(t / 2e-3));
            const double sign = turned ? -1 : 1, w = 8 * t * t * t, rate = sign * 24 * t * t;
            const Eigen::Vector2d along(0.6, 0.8), across(-0.8, 0.6);
            const Eigen::Vector2d f = sign * (-w * w * along + rate * across);
            const double size = 64 + 24;
            CHECK(std::abs(at["f.x"][i] - f.x()) < 2e-4 * size);
            CHECK(std::abs(at["f.y"][i] - f.y()) < 2e-4 * size);
            CHECK(std::abs(at["m.z"][i] - sign * 2. / 3 * rate) < 4e-4 * 16);
            if (spatial) CHECK(std::abs(at["f.z"][i]) < 1e-6 * size);
            CHECK(at["g.x"][i] == at["w.x"][i]);
            CHECK(at["g.y"][i] == at["w.y"][i]);
          }
        }
}

TEST_CASE("reactions in the axes of a joint: about a free axis there is no moment, along a slide no force",
          "[verification]") {
  const History hinge = move(R"yaml(
gravity: [0, 0, -9.81]
bodies: {lid: {rigid: {mass: 2, centre: [0.3, 0.1, 0.2], inertia: [1, 2, 3]}, initial: {rotation: [0.3, 0.2, -0.5]}}}
joints: {hinge: {type: revolute, between: [ground, {body: lid, node: [0, 0, 0]}], axis: [1, 2, -1]}}
motion: {end: 1, step: 2e-3}
probes:
  f: {joint: hinge, axes: joint}
  m: {joint: hinge, quantity: moment, axes: joint}
  world: {joint: hinge, quantity: moment}
)yaml",
                             Formulation::vm_md);
  double free = 0, held = 0;
  for (std::size_t i = 0; i < hinge.t.size(); ++i) {
    free = std::max(free, std::abs(hinge["m.z"][i]));
    held = std::max(held, std::hypot(hinge["m.x"][i], hinge["m.y"][i]));
    const Eigen::Vector3d world(hinge["world.x"][i], hinge["world.y"][i], hinge["world.z"][i]);
    CHECK(world.norm() == Approx(std::hypot(hinge["m.x"][i], hinge["m.y"][i], hinge["m.z"][i])));
  }
  CHECK(held > 1);
  CHECK(free < 1e-9 * held);

  const History slide = move(R"yaml(
gravity: [0, -10]
bodies: {mass: {rigid: {mass: 3, centre: [0, 0], inertia: 1}}}
joints: {slide: {type: prismatic, between: [mass.centre, ground], axis: [0.6, 0.8]}}
motion: {end: 0.1, step: 1e-2}
probes: {f: {joint: slide, axes: joint}}
)yaml",
                             Formulation::vm_md);
  CHECK(std::abs(slide["f.x"].back()) < 1e-9);
  CHECK(slide["f.y"].back() == Approx(-3 * 10 * 0.6));  // on the ground
}
