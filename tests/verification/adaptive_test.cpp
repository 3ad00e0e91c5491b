#include <catch2/catch.hpp>

#include "scene_motion.h"

using namespace floe;
using namespace floe::test;

// Adaptive steps see what happens between their ends. The estimated error of q at the end of a step is zero where
// drives prescribe q, and where neither end is in the range in which a load acts.

namespace {

/// Errors of positions and velocities at the ends of steps and in the middle between them, where the cubic through both
/// ends is.
double greatest_error_between(const History& at, const std::string& x, const std::string& v,
                              const std::function<double(double)>& exact) {
  double greatest = 0;
  for (std::size_t i = 1; i < at.t.size(); ++i) {
    const double h = at.t[i] - at.t[i - 1];
    const double middle = 0.5 * (at[x][i - 1] + at[x][i]) + h / 8 * (at[v][i - 1] - at[v][i]);
    greatest = std::max(
        {greatest, std::abs(at[x][i] - exact(at.t[i])), std::abs(middle - exact(0.5 * (at.t[i - 1] + at.t[i])))});
  }
  return greatest;
}

}  // namespace

// Steps grew without limit: positions between them were 0.97 m off for an amplitude of 0.1 m.
TEST_CASE("adaptive steps resolve a slide that a drive moves") {
  for (const double tolerance : {1e-4, 1e-6, 1e-8}) {
    const History at = move(fill(R"yaml(
bodies: {s: {rigid: {mass: 1.5, centre: [0, 0, 0], inertia: [0.1, 0.1, 0.1]}}}
joints: {p: {type: driven_slide, between: [ground, s.centre], axis: [1, 0, 0], position: "0.1*sin(10*t)"}}
motion: {end: 3, step: 1e-3, tolerance: $tolerance}
probes: {x: {joint: p, quantity: travel}, v: {joint: p, quantity: speed}, d: {joint: p, quantity: drive}}
)yaml",
                                 {{"tolerance", number(tolerance)}}),
                            Formulation::vm_md);
    INFO(tolerance << ", " << at.report.steps << " steps");
    const auto exact = [](double t) { return 0.1 * std::sin(10 * t); };
    // rates at the ends of steps have errors of their own
    CHECK(greatest_error_between(at, "x.value", "v.value", exact) < 3 * tolerance);
    CHECK(at.report.steps < 40 / std::cbrt(tolerance));
  }
}

// A crank of 0.2 m and a rod of 0.6 m: x = r cos a + sqrt(l^2 - r^2 sin^2 a). Steps of several rotations ended on the
// other branch (x = -2.3 m).
TEST_CASE("adaptive steps resolve a slider-crank that a drive rotates") {
  const std::string text = R"yaml(
bodies:
  crank: {rigid: {mass: 2, centre: [0.1, 0], inertia: 0.02}}
  rod: $rod
  slider: {rigid: {mass: 3, centre: [0, 0], inertia: 0.05}, initial: {position: [0.8, 0]}}
joints:
  h: {type: driven, between: [ground, {body: crank, node: [0, 0]}], angle: "20*(t-0.1*(1-exp(-t/0.1)))"}
  p: {type: revolute, between: [{body: crank, node: [0.2, 0]}, {body: rod, node: [0, 0]}]}
  q: {type: revolute, between: [{body: rod, node: [0.6, 0]}, slider.centre]}
  s: {type: prismatic, between: [ground, slider.centre]}
motion: {end: 1.5, step: $step, tolerance: $tolerance}
probes: {x: {at: slider.centre, quantity: position}, v: {at: slider.centre, quantity: velocity}}
)yaml";
  const auto exact = [](double t) {
    const double a = 20 * (t - 0.1 * (1 - std::exp(-t / 0.1)));
    return 0.2 * std::cos(a) + std::sqrt(0.36 - 0.04 * std::sin(a) * std::sin(a));
  };
  for (const double tolerance : {1e-4, 1e-6}) {
    const History at =
        move(fill(text, {{"rod", "{rigid: {mass: 1, centre: [0.3, 0], inertia: 0.05}, initial: {position: [0.2, 0]}}"},
                         {"step", "1e-3"},
                         {"tolerance", number(tolerance)}}),
             Formulation::vm_md);
    INFO(tolerance << ", " << at.report.steps << " steps");
    CHECK(greatest_error_between(at, "x.x", "v.x", exact) < 30 * tolerance);  // of a distance of up to 30 rad
  }
  // of steel: the constraints depended on one another in a wrong position, and the simulation stopped
  const History flexible = move(fill(text, {{"rod", R"(
    mesh: {line: {from: [0, 0], to: [0.6, 0], elements: 8}}
    section: {shape: rectangle, width: 0.02, height: 0.03}
    material: {E: 2.1e11, rho: 7850}
    reduction: {modes: 2}
    initial: {position: [0.2, 0]})"},
                                            {"step", "1e-4"},
                                            {"tolerance", "1e-5"}}),
                                Formulation::vm_md);
  CHECK(greatest_error_between(flexible, "x.x", "v.x", exact) < 1e-3);
}

// Thrown up at 5 m/s, decelerated by 20 N more above 0.6 m: the height is 0.6 + v^2 / (2 (g + 20 / m)),
// v^2 = 25 - 1.2 g. A step from below to below saw no load, whatever the tolerance.
TEST_CASE("adaptive steps resolve a load that begins and ends between their ends") {
  const std::string text = R"yaml(
gravity: [0, -9.81]
bodies: {m: {rigid: {mass: 1.5, centre: [0, 0], inertia: 0.1}, initial: {velocity: [0, 5]}}}
joints: {p: {type: prismatic, between: [ground, m.centre], axis: [0, 1]}}
motion: {end: 1, step: 1e-2, tolerance: 1e-6}
probes: {h: {at: m.centre, quantity: position}, v: {at: m.centre, quantity: velocity}}
loads: {f: {type: force, at: m.centre, force: [0, "$force"]}}
)yaml";
  const auto highest = [&](const std::string& force) {
    const History at = move(fill(text, {{"force", force}}), Formulation::vm_md);
    double top = 0;
    for (std::size_t i = 1; i < at.t.size(); ++i)
      if (at["v.y"][i] < 0 && at["v.y"][i - 1] > 0) {
        const double h = at.t[i] - at.t[i - 1];
        top = 0.5 * (at["h.y"][i - 1] + at["h.y"][i]) + h / 8 * (at["v.y"][i - 1] - at["v.y"][i]);
      }
    return top;
  };
  const double square = 25 - 1.2 * 9.81, weight = 1.5 * 9.81;
  CHECK(highest("h.y > 0.6 ? -20 : 0") == Approx(0.6 + 0.75 * square / (weight + 20)).epsilon(2e-3));
  // a spring of 1e4 N/m: k d^2 / 2 + m g d = m v^2 / 2
  const double d = (-weight + std::sqrt(weight * weight + 1e4 * 1.5 * square)) / 1e4;
  CHECK(highest("-1e4*max(0, h.y - 0.6)") == Approx(0.6 + d).epsilon(2e-3));
}

// y = 5 t - g t^2 / 2 crosses 0.6, 1 and 1.2 m on its way up: once more on its way down, within one step of 2 s.
TEST_CASE("events that a step crosses forth and back happen, in adaptive steps and in fixed ones") {
  for (const double level : {0.6, 1.0, 1.2, 1.27, 1.2703})
    for (const std::string& steps :
         {std::string("step: 1e-2, tolerance: 1e-3"), std::string("step: 1e-2, tolerance: 1e-8"),
          std::string("step: 0.3"), std::string("step: 0.27"), std::string("step: 0.54, tolerance: 1e-3"),
          std::string("step: 0.05")}) {
      INFO(level << " " << steps);
      const History at = move(fill(R"yaml(
gravity: [0, -9.81]
bodies: {m: {rigid: {mass: 1.5, centre: [0, 0], inertia: 0.1}, initial: {velocity: [0, 5]}}}
motion: {end: 2, $steps}
probes: {m: {at: m.centre, quantity: position}}
events: {e: {stop: true, probe: m.y, crosses: $level}}
)yaml",
                                   {{"steps", steps}, {"level", number(level)}}),
                              Formulation::vm_md);
      REQUIRE(at.events.size() == 1);
      CHECK(at.events[0].t == Approx((5 - std::sqrt(25 - 2 * 9.81 * level)) / 9.81).epsilon(1e-6));
    }
}

// 0.1 sin(10 t) is above 0.0999 for 9 ms.
TEST_CASE("events near the maxima of an oscillation happen in fixed steps") {
  for (const char* step : {"0.05", "0.03", "0.0371"}) {
    INFO(step);
    const History at = move(fill(R"yaml(
bodies: {s: {rigid: {mass: 1.5, centre: [0, 0, 0], inertia: [0.1, 0.1, 0.1]}}}
joints: {p: {type: driven_slide, between: [ground, s.centre], axis: [1, 0, 0], position: "0.1*sin(10*t)"}}
motion: {end: 1, step: $step}
probes: {x: {joint: p, quantity: travel}}
events: {e: {stop: true, probe: x.value, crosses: 0.0999}}
)yaml",
                                 {{"step", step}}),
                            Formulation::vm_md);
    REQUIRE(at.events.size() == 1);
    CHECK(at.events[0].t == Approx(std::asin(0.999) / 10).epsilon(0.01));
  }
}
