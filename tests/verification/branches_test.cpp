#include <catch2/catch.hpp>

#include "../../src/app/campbell.h"
#include "../../src/app/equilibrium.h"
#include "truss.h"

using namespace floe;
using namespace floe::test;

namespace {

app::RunResult at_rest(const std::string& text, Formulation formulation, int steps, double at = 1) {
  return app::rest(scene::parse_scene(text, "scene"), formulation, PETSC_COMM_WORLD, {at, steps}, std::nullopt, false);
}

int jumps_of(const app::RunResult& result) {
  return static_cast<int>(std::count_if(result.warnings.begin(), result.warnings.end(), [](const std::string& words) {
    return words.find("the equilibrium jumps between t = ") != std::string::npos;
  }));
}

}  // namespace

// The limit load to (h/L)^2; the tangents vanish with the step, the snap does not.
TEST_CASE("static: a snap-through is reported with its location") {
  const double h = 0.05, limit = 1e3 * 2 * std::pow(h, 3) / (3 * std::sqrt(3.));
  for (const Formulation formulation : {Formulation::nlffr, Formulation::vm_md})
    for (const int steps : {1, 10}) {
      const app::RunResult through = at_rest(truss(h), formulation, steps, 1.5 * limit);
      REQUIRE(jumps_of(through) == 1);
      const auto& jump = through.summary["jumps"].at(0);
      CHECK(jump["ratio"].get<double>() > 3);
      CHECK(jump["from"].get<double>() < 1.003 * limit);
      CHECK(jump["to"].get<double>() > 0.997 * limit);
      CHECK(jump["to"].get<double>() - jump["from"].get<double>() < 0.01 * limit);
      CHECK(jumps_of(at_rest(truss(h), formulation, steps, 0.98 * limit)) == 0);
    }
}

TEST_CASE("static: large steps along one branch are no jumps") {
  const std::string text = R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 8}}
    section: {EA: 1e5, EI: 1, rhoA: 1}
    reduction: {modes: 6}
joints: {a: {type: revolute, between: [ground, beam.start]}, b: {type: revolute, between: [ground, beam.end]}}
loads: {q: {type: distributed, body: beam, force: [0, 100*t]}}
probes: {middle: {at: beam.middle}}
)yaml";
  for (const int steps : {1, 10}) CHECK(jumps_of(at_rest(text, Formulation::nlffr, steps)) == 0);
}

// A narrow cantilever beyond Michell's load 4.013 sqrt(EI GJ) / L^2, with 0.09 % of it to one side: mirror images are
// near one another where it buckles. In steps of 1/24 and 1/25 it came to the other side, -0.103.
TEST_CASE("static: a cantilever that buckles to the side of a small force stays on that side") {
  const std::string text = R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: 16}}
    section: {A: 1e-4, Iy: 1e-11, Iz: 1e-7, J: 4e-11, orientation: [0, 1, 0]}
    material: {E: 7e10, G: 2.6e10, rho: 2700}
joints: {root: {type: fixed, between: [ground, beam.start]}}
loads: {tip: {type: force, at: beam.end, force: [0, "3.492140675225171*t", "0.003*t"]}}
probes: {tip: {at: beam.end}}
)yaml";
  for (const int steps : {10, 24, 25, 30}) {
    CAPTURE(steps);
    const app::RunResult found = at_rest(text, Formulation::nlffr, steps);
    CHECK(found.series.values.back().at(2) == Approx(0.1322).epsilon(1e-3));
    CHECK(jumps_of(found) == 0);
  }
}

// A strut that is shortened by s = .004 L between hinges bows by +-(2/pi) sqrt(s - pi^2 EI/EA) L: .0398 for EA = 1e5
// EI.
TEST_CASE("static: a strut that starts bowed to one side has its equilibrium there") {
  const auto middle = [](const std::string& bow, Formulation formulation) {
    const app::RunResult result = at_rest(fill(R"yaml(
bodies:
  strut:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 16}}
    section: {EA: 1e5, EI: 1, rhoA: 1}
    reduction: {modes: 4}
    initial: {deformation: ["-0.004*x", "$bow*sin(pi*x)"]}
joints: {a: {type: revolute, between: [ground, strut.start]}, b: {type: revolute, between: [ground, strut.end]}}
probes: {middle: {at: strut.middle, quantity: position}}
)yaml",
                                               {{"bow", bow}}),
                                          formulation, 1);
    return result.series.values.back().at(1);
  };
  const double bow = 2 / M_PI * std::sqrt(0.004 - M_PI * M_PI * 1e-5);
  for (const std::string start : {"0.02", "0.01", "0.06"}) {
    INFO(start);
    CHECK(middle(start, Formulation::nlffr) == Approx(bow).epsilon(2e-3));
    CHECK(middle("-" + start, Formulation::nlffr) == Approx(-bow).epsilon(2e-3));
  }
}

namespace {

/// A rigid rod of length L, hinged at the distance e from a vertical axis, which begins at the angle `angle` below the
/// horizontal outwards. Its angle b from the downward vertical, outwards, is an equilibrium at the speed W where
/// f(b) = W^2 cos b (e/2 + L sin b/3) - g sin b/2 = 0, and small motions have -3 f'(b)/L = omega^2.
struct HingedRod {
  double e, angle;
  static constexpr double L = 0.75, g = 9.81;

  app::CampbellDiagram at(const std::string& speeds) const {
    app::CampbellRequest request;
    request.speeds = speeds, request.modes = 1;
    std::exception_ptr fault;
    app::CampbellDiagram found =
        app::campbell(scene::parse_scene(fill(R"yaml(
gravity: [0, 0, -9.81]
bodies:
  hub:
    rigid: true
    mesh: {line: {from: [0, 0, 0], to: [$e, 0, 0], elements: 1}}
    section: {shape: rectangle, width: 0.02, height: 0.02, orientation: [0, 1, 0]}
    material: {E: 7e10, nu: 0.3, rho: 2700}
  rod:
    rigid: true
    mesh: {line: {from: [0, 0, 0], to: [$L, 0, 0], elements: 6}}
    section: {A: 1e-4, Iy: 1e-20, Iz: 1e-20, J: 1e-20, orientation: [0, 1, 0]}
    material: {E: 7e10, nu: 0.3, rho: 2700}
    initial: {rotation: [0, $angle, 0], position: [$e, 0, 0]}
joints:
  drive: {type: driven, between: [ground, hub.start], axis: [0, 0, 1], angle: "t"}
  hinge: {type: revolute, between: [hub.end, rod.start], axis: [0, 1, 0]}
)yaml",
                                              {{"e", number(e)}, {"angle", number(angle)}, {"L", number(L)}}),
                                         "scene"),
                      Formulation::vm_md, PETSC_COMM_WORLD, request, fault);
    if (fault) std::rethrow_exception(fault);
    return found;
  }
  double torque(double W, double b) const {
    return W * W * std::cos(b) * (e / 2 + L * std::sin(b) / 3) - g * std::sin(b) / 2;
  }
  /// omega^2 of the equilibrium between two angles of torques of opposite sign.
  double square(double W, double low, double high) const {
    const bool rises = torque(W, high) > 0;
    REQUIRE(rises != (torque(W, low) > 0));
    for (int i = 0; i < 60; ++i) ((torque(W, (low + high) / 2) > 0) == rises ? high : low) = (low + high) / 2;
    return -3 / L * (torque(W, low + 1e-6) - torque(W, low - 1e-6)) / 2e-6;
  }
};

int warnings_of(const app::CampbellDiagram& diagram, const std::string& words) {
  return static_cast<int>(
      std::count_if(diagram.model.warnings.begin(), diagram.model.warnings.end(),
                    [&](const std::string& text) { return text.find(words) != std::string::npos; }));
}

}  // namespace

// It hangs outwards at all speeds; inwards there is an unstable equilibrium, too.
TEST_CASE("campbell: the branch is followed, whatever the steps of the speed") {
  const HingedRod rod{0.02, 0.5};
  for (const std::string speeds : {"4,5,6", "4,6", "3,4,4.2,4.4,4.6,4.8,5,6"}) {
    const auto found = rod.at(speeds);
    INFO(speeds);
    CHECK(warnings_of(found, "another branch") == 0);
    for (const app::CampbellPoint& point : found.points) {
      REQUIRE(point.fault == "");
      CHECK(point.search.jump.ratio == 0);
      CHECK(point.vibrations.at(0).growth == 0);
      CHECK(point.vibrations.at(0).omega == Approx(std::sqrt(rod.square(point.speed, 0.01, M_PI / 2))).epsilon(1e-4));
    }
  }
}

// Across the axis it hangs above a speed only: where the maximum torque towards the horizontal, over all angles, is 0.
TEST_CASE("campbell: a branch that ends is left with a warning that gives the speed") {
  const HingedRod rod{0.05, 2.9};
  const auto steepest = [&](double W) {  // the angle of the maximum torque
    double at = 0;
    for (double b = 0; b > -M_PI / 2; b -= 1e-4)
      if (-rod.torque(W, b) > -rod.torque(W, at) || at == 0) at = b;
    return at;
  };
  double end = 4, above = 8;
  while (above - end > 1e-6)
    (-rod.torque((end + above) / 2, steepest((end + above) / 2)) > 0 ? above : end) = (end + above) / 2;
  const auto found = rod.at("10,8,6,3");
  REQUIRE(found.points.size() == 4);
  for (int i = 0; i < 3; ++i) {
    const app::CampbellPoint& point = found.points[i];
    CHECK(point.search.jump.ratio == 0);
    CHECK(point.vibrations.at(0).omega ==
          Approx(std::sqrt(rod.square(point.speed, -M_PI / 2, steepest(point.speed)))).epsilon(1e-4));
  }
  const solve::BranchJump& jump = found.points[3].search.jump;
  CHECK(jump.ratio > 3);
  CHECK(jump.from > end);
  CHECK(jump.to < end);
  CHECK(jump.from - jump.to < 0.05);
  CHECK(warnings_of(found, "the steady rotation jumps to another branch") == 1);
}

// Upright it falls at one rate; the only exponents are +- that rate. Rigid bodies have no reduced model.
TEST_CASE("campbell: an upright rod falls at the rate of its closed form") {
  const HingedRod rod{0.05, 1.5 * M_PI + 0.1};
  const auto found = rod.at("0.5,1,1.5,2,2.5,3,3.5,4,4.5,5");
  for (const app::CampbellPoint& point : found.points) {
    INFO(point.speed);
    REQUIRE(point.fault == "");
    REQUIRE(point.vibrations.size() == 1);
    CHECK(point.vibrations[0].growth ==
          Approx(std::sqrt(-rod.square(point.speed, -M_PI - 0.2, -M_PI + 0.2))).epsilon(1e-4));
  }
  CHECK(warnings_of(found, "reduced model") == 0);
}

// Two hinged bars on a hub, bent towards the axis by the rise h, snap through where the centrifugal force of the mass
// at their apex is the limit load of von Mises' truss.
TEST_CASE("a motion that starts in a steady rotation reports that the branch was left on the way") {
  const double h = 0.05, R = 10, limit = 1e3 * 2 * std::pow(h, 3) / (3 * std::sqrt(3.)),
               end = std::sqrt(limit / (R - h / std::sqrt(3.)));
  const auto jumps = [&](double speed) {
    const assembly::Model model =
        assembly::build(scene::parse_scene(fill(R"yaml(
bodies:
  hub:
    rigid: true
    mesh: {polyline: {points: [[0, 0], [$R, -1], [$R, 1]], elements: 1}}
    section: {EA: 1, EI: 1, rhoA: 1}
  a:
    mesh: {line: {from: [$R, -1], to: [$r, 0], elements: 2}}
    section: {EA: 1e3, EI: 10, rhoA: 1e-6}
  b:
    mesh: {line: {from: [$r, 0], to: [$R, 1], elements: 2}}
    section: {EA: 1e3, EI: 10, rhoA: 1e-6}
  mass: {rigid: {mass: 1, centre: [$r, 0], inertia: 1e-3}}
joints:
  drive: {type: driven, between: [ground, hub.p1], angle: "$speed*t"}
  left: {type: revolute, between: [hub.p2, a.start]}
  apex: {type: revolute, between: [a.end, b.start]}
  grip: {type: fixed, between: [a.end, mass.centre]}
  right: {type: revolute, between: [hub.p3, b.end]}
motion: {end: 0.01, step: 1e-3, start: steady_rotation}
)yaml",
                                                {{"R", number(R)}, {"r", number(R - h)}, {"speed", number(speed)}}),
                                           "scene"),
                        Formulation::vm_md, PETSC_COMM_WORLD, true);
    return std::count_if(model.warnings.begin(), model.warnings.end(), [](const std::string& text) {
      return text.find("the steady rotation jumps to another branch") != std::string::npos;
    });
  };
  CHECK(jumps(0.98 * end) == 0);
  CHECK(jumps(1.08 * end) == 1);
}

// A strip of shells, swept by 0.5 rad: its sixth mode is in its plane. At full order it is stable, and with strains of
// second order reduced, too: with von Karman's it takes the sixth mode's derivatives, which lack the rotation in the
// plane, for compression.
TEST_CASE("campbell: an instability of the reduced model only is reported as such") {
  const std::string strip = R"yaml(
bodies:
  hub:
    rigid: true
    mesh: {line: {from: [0, 0, 0], to: [0.1, 0, 0], elements: 1}}
    section: {shape: rectangle, width: 0.05, height: 0.05, orientation: [0, 1, 0]}
    material: {E: 7e10, nu: 0.3, rho: 2700}
  strip:
    mesh: {plate: {along: ["cos(0.5)", "sin(0.5)", 0], across: ["-0.1*sin(0.5)", "0.1*cos(0.5)", 0], elements: [10, 2]}}
    section: {thickness: 2e-3}
    material: {E: 7e10, nu: 0.3, rho: 2700}
    strains: $strains
    frame: {type: clamped, at: left}
    reduction: {modes: $modes}
    initial: {position: ["0.1 + 0.05*sin(0.5)", "-0.05*cos(0.5)", 0]}
joints:
  drive: {type: driven, between: [ground, hub.start], axis: [0, 0, 1], angle: "t"}
  weld: {type: fixed, between: [hub.end, strip.left]}
)yaml";
  for (const auto& [modes, strains] : {std::pair<std::string, std::string>{"6", "von_karman"},
                                       {"8", "von_karman"},
                                       {"6", "second_order"},
                                       {"8", "second_order"}}) {
    INFO(strains << " " << modes);
    app::CampbellRequest request;
    request.speeds = "100", request.modes = 2;
    std::exception_ptr fault;
    const app::CampbellDiagram found =
        app::campbell(scene::parse_scene(fill(strip, {{"modes", modes}, {"strains", strains}}), "strip"),
                      Formulation::vm_md, PETSC_COMM_WORLD, request, fault);
    if (fault) std::rethrow_exception(fault);
    const auto& all = found.points.at(0).vibrations;
    const bool unstable = std::any_of(all.begin(), all.end(), [](const auto& v) { return v.unstable(); });
    CHECK(unstable == (modes == "6" && strains == "von_karman"));
    CHECK(std::count_if(found.model.warnings.begin(), found.model.warnings.end(), [](const std::string& words) {
            return words.find("the full-order model of the same mesh is stable there") != std::string::npos;
          }) == (unstable ? 1 : 0));
  }
}

// The lock is open: it does not count as a constraint that repeats another one where the level rod's tangent is
// singular.
TEST_CASE("equilibria leave out events, which is reported") {
  const app::RunResult result = at_rest(R"yaml(
gravity: [0, -9.81]
bodies: {rod: {rigid: {mass: 1, centre: [0.5, 0], inertia: 0.1}}}
joints: {h: {type: revolute, between: [ground, {body: rod, node: [0, 0]}]}}
events: {catch: {lock: h, at: 0.5}}
probes: {a: {joint: h, quantity: angle}}
motion: {end: 1, step: 0.1}
)yaml",
                                        Formulation::vm_md, 2);
  CHECK(result.series.values.back()[0] == Approx(-M_PI / 2).epsilon(1e-6));
  CHECK(std::count_if(result.warnings.begin(), result.warnings.end(), [](const std::string& words) {
          return words.find("equilibria do not take account of events (catch)") != std::string::npos;
        }) == 1);
}
