#include <catch2/catch.hpp>
#include <numeric>
#include <optional>

#include "space_twin.h"

using namespace floe;
using namespace floe::test;

// Drives with kinks, and loads with jumps: velocities jump by the impulse of the drive, and what comes after is right
// to the order of the method. Closed forms of rigid bodies; for an elastic one the modes of a beam that is struck.

namespace {

/// A bar of mass 3 and length 1 that rotates about its end, inertia 1; a second one hinged to its tip.
std::string bars(const std::string& drive, const std::string& motion, bool two = false) {
  return fill(R"yaml(
bodies:
  bar:
    rigid: true
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 2}}
    section: {rhoA: 3}
$second
joints:
  motor: {type: driven, between: [ground, bar.start], $drive}
$hinge
motion: $motion
probes: {tip: {at: bar.end, quantity: velocity}, root: {at: bar.end, quantity: rotation}}
)yaml",
              {{"drive", drive},
               {"motion", motion},
               {"second", two ? R"yaml(
  rod:
    rigid: true
    mesh: {line: {from: [0, 0], to: [0.8, 0], elements: 2}}
    section: {rhoA: 2.5}
    initial: {position: [1, 0]})yaml"
                              : ""},
               {"hinge", two ? "  hinge: {type: revolute, between: [bar.end, rod.start]}" : ""}});
}

double speed(const History& at, std::size_t i) { return std::hypot(at["tip.x"][i], at["tip.y"][i]); }

}  // namespace

TEST_CASE("a ramp of the angle: the speed is that of the ramp, with fixed and adaptive steps, on and off the grid") {
  for (const std::string motion :
       {"{end: .5, step: .01}", "{end: .5, step: .0137}", "{end: .5, step: .01, tolerance: 1e-6}"}) {
    INFO(motion);
    const History at = move(bars("angle: \"ramp(t, .1, .3)\"", motion), Formulation::vm_md);
    for (std::size_t i = 0; i < at.t.size(); ++i) {
      const bool rotations = at.t[i] > 0.1 + 1e-9 && at.t[i] < 0.3 + 1e-9;
      CHECK(speed(at, i) == Approx(rotations ? 5 : 0).margin(1e-7));
      CHECK(at.energy[i].kinetic == Approx(rotations ? 12.5 : 0).margin(1e-6));
    }
    REQUIRE(at.events.size() == 2);
    CHECK(at.events[0].t == Approx(0.1).epsilon(1e-14));
    CHECK(at.events[0].name == "motor");
    CHECK(at.events[0].what == "speed of the drive jumps from 0 to 5 rad/s");
    CHECK(at.events[0].work.value() == Approx(12.5));
    CHECK(at.events[1].what == "speed of the drive jumps from 5 to 0 rad/s");
    CHECK(at.events[1].work.value() == Approx(-12.5));
  }
}

// The rod is free but for the force J at its end: v_end = J (1/m + (l/2)^2/(m l^2/12)) = 4 J/m, so that J = m v/4 and
// the energy is J v/2 = m v^2/8; it rotates against the bar by 3 v/(2 l).
TEST_CASE("a drive that starts suddenly: impulse, energy and motion as of a free rod") {
  const double step = 0.002;
  const History at = move(bars("angle: \"ramp(t, .1, 10.1)*40\"", fmt::format("{{end: .2, step: {}}}", step), true),
                          Formulation::vm_md);
  REQUIRE(at.events.size() == 1);
  CHECK(at.events[0].work.value() == Approx(0.5 * 16 + 2 * 16. / 8).epsilon(1e-10));
  for (std::size_t i = 0; i < at.t.size(); ++i)
    CHECK(speed(at, i) == Approx(at.t[i] > 0.1 + 1e-9 ? 4 : 0).margin(1e-4));
}

TEST_CASE("kinks of abs, of a speed that jumps and of a slide in space") {
  const History back = move(bars("angle: \"abs(t - .233) - .233\"", "{end: .5, step: .01}"), Formulation::vm_md);
  for (std::size_t i = 0; i < back.t.size(); ++i) CHECK(speed(back, i) == Approx(1).epsilon(1e-9));
  REQUIRE(back.events.size() == 1);
  CHECK(back.events[0].t == Approx(0.233).epsilon(1e-14));
  CHECK(back.events[0].work.value() == Approx(0).margin(1e-12));

  const History jump = move(bars("speed: \"t < .123 ? 2 : 3 + t\"", "{end: .5, step: .01}"), Formulation::vm_md);
  REQUIRE(jump.events.size() == 1);
  CHECK(jump.t.back() == Approx(0.5));
  CHECK(jump["root.angle"].back() == Approx(0.246 + 3 * 0.377 + (0.25 - 0.123 * 0.123) / 2));
  CHECK(speed(jump, jump.t.size() - 1) == Approx(3.5).epsilon(1e-6));

  const Rotated rotation;
  const History slide = move(fill(R"yaml(
bodies:
  cube:
    rigid: true
    mesh: {line: {from: [-0.1, 0, 0], to: [0.1, 0, 0], elements: 2}}
    section: {shape: rectangle, width: 0.2, height: 0.2, orientation: [0, 1, 0]}
    material: {E: 1, nu: 0.3, rho: 125}
    initial: {rotation: $turn}
joints: {drive: {type: driven_slide, between: [ground, cube.middle], axis: $axis, position: "max(0, 2*(t - .105))"}}
motion: {end: .3, step: .01}
probes: {middle: {at: cube.middle, quantity: velocity}}
)yaml",
                                  {{"turn", rotation.text()}, {"axis", rotation(0, 0, 1)}}),
                             Formulation::vm_md);
  REQUIRE(slide.events.size() == 1);
  CHECK(slide.events[0].what == "speed of the drive jumps from 0 to 2 m/s");
  CHECK(slide.events[0].work.value() == Approx(2));  // 1 kg
  for (std::size_t i = 0; i < slide.t.size(); ++i)
    CHECK(vector_at(slide, "middle", i).norm() == Approx(slide.t[i] > 0.105 + 1e-9 ? 2 : 0).margin(1e-9));
}

TEST_CASE("a kink at the start: the simulation begins with the speed just after it") {
  for (const std::string angle : {"abs(t)", "ramp(t, 0, 10)*10", "t > 0 ? t : 0"}) {
    const History at = move(bars("angle: \"" + angle + "\"", "{end: .1, step: .01}"), Formulation::vm_md);
    CHECK(at.events.empty());
    for (std::size_t i = 0; i < at.t.size(); ++i) CHECK(speed(at, i) == Approx(1).epsilon(1e-9));
  }
}

// r = 0.2 t^1.5: w = 0.3 sqrt(t); the angular acceleration is infinite at t = 0.
TEST_CASE("a drive of infinite acceleration is smoothed for ten steps with a warning, and exact after them") {
  const History at = move(bars("angle: \".2*sqrt(t^3)\"", "{end: .5, step: .005}"), Formulation::vm_md);
  REQUIRE(at.model.warnings.size() == 1);
  CHECK_THAT(at.model.warnings[0],
             Catch::Matchers::Contains("is infinite at t = 0 s") && Catch::Matchers::Contains("for 0.05 s (10 steps)"));
  for (std::size_t i = 0; i < at.t.size(); ++i)
    CHECK(speed(at, i) == Approx(0.3 * std::sqrt(at.t[i])).margin(at.t[i] < 0.05 ? 0.03 : 2e-3));
}

// m v = F (t - t1): forces that begin and end between the steps' instants of a whole step.
TEST_CASE("a force with jumps acts for its exact duration, gravity and the ground's acceleration likewise") {
  const std::string text = R"yaml(
bodies:
  bar: {rigid: true, mesh: {line: {from: [0, 0], to: [1, 0], elements: 2}}, section: {rhoA: 3}}
$load
motion: {end: .5, step: .01}
probes: {m: {at: bar.middle, quantity: velocity}}
)yaml";
  for (const std::string load :
       {"loads: {push: {type: force, at: bar.middle, force: [0, \"30*pulse(t, .1033, .3577)\"]}}",
        "gravity: [0, \"10*pulse(t, .1033, .3577)\"]", "ground: {acceleration: [0, \"-10*pulse(t, .1033, .3577)\"]}"}) {
    INFO(load);
    const History at = move(fill(text, {{"load", load}}), Formulation::vm_md);
    CHECK(at.events.empty());
    for (std::size_t i = 0; i < at.t.size(); ++i)
      CHECK(at["m.y"][i] == Approx(10 * std::clamp(at.t[i] - 0.1033, 0.0, 0.2544)).margin(1e-10));
  }
}

// m u.. = 30 (1 - u) for t1 <= t < t2: u = 1 - cos(w (t - t1)), w^2 = 10; then the speed remains w sin(w (t2 - t1)).
TEST_CASE("a force of a sensor that jumps in time acts for its exact duration") {
  const std::string text = R"yaml(
bodies:
  bar: {rigid: true, mesh: {line: {from: [0, 0], to: [1, 0], elements: 2}}, section: {rhoA: 3}}
loads: {push: {type: force, at: bar.middle, force: [0, "30*(1 - d.y)*pulse(t, .1033, .3577)"]}}
motion: {end: .5, step: .01}
probes: {d: {at: bar.middle}, m: {at: bar.middle, quantity: velocity}}
)yaml";
  const std::vector<dynamics::Kink> kinks = assembly::kinks_of(scene::parse_scene(text, "test.yaml"), 0.5);
  REQUIRE(kinks.size() == 2);
  CHECK(kinks[0].before == Approx(0.1033));
  CHECK(kinks[1].before == Approx(0.3577));
  const History at = move(text, Formulation::vm_md);
  const double w = std::sqrt(10.0);
  CHECK(at["m.y"].back() == Approx(w * std::sin(w * 0.2544)).epsilon(2e-4));
}

// Steps that resolve the vibrations which the kink excites.
TEST_CASE("order 2 behind a kink, in every formulation") {
  const auto swing = [](double step, Formulation formulation) {
    return move(fill(R"yaml(
bodies:
  arm:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 4}}
    section: {EA: 1e5, EI: 20, rhoA: 1, rhoI: 1e-3}
    frame: {type: clamped, at: start}
    reduction: {modes: 2, derivatives: all}
joints: {motor: {type: driven, between: [ground, arm.start], angle: ".5*ramp(t, .0511, .3)"}}
motion: {end: .2, step: $step, spectral_radius: .9}
probes: {tip: {at: arm.end, quantity: position}}
)yaml",
                     {{"step", number(step)}}),
                formulation);
  };
  for (const Formulation formulation : {Formulation::vm_md, Formulation::vm}) {
    const History fine = swing(2e-5, formulation);
    const double coarse = std::abs(swing(2e-4, formulation)["tip.y"].back() - fine["tip.y"].back()),
                 middle = std::abs(swing(1e-4, formulation)["tip.y"].back() - fine["tip.y"].back());
    INFO(coarse << ", " << middle);
    CHECK(std::log2(coarse / middle) == Approx(2).margin(0.4));
  }
  // All formulations of the same mesh agree on the way that the root goes, and on the energy that the kink brings.
  const History full = swing(1e-3, Formulation::nlffr), corotational = swing(1e-3, Formulation::cfr);
  REQUIRE(full.events.size() == 1);
  REQUIRE(corotational.events.size() == 1);
  CHECK(full.events[0].work.value() == Approx(corotational.events[0].work.value()).epsilon(0.02));
}

TEST_CASE("an angle that jumps is refused, and so is an infinite speed") {
  using Catch::Matchers::Contains;
  CHECK_THROWS_WITH(move(bars("angle: \"t < .105 ? 0 : .5\"", "{end: .5, step: .01}"), Formulation::vm_md),
                    Contains("motor.angle: ") && Contains("jumps from 0 to 0.5 rad at t = 0.105"));
  CHECK_THROWS_WITH(move(bars("angle: \"sqrt(t)\"", "{end: .5, step: .01}"), Formulation::vm_md),
                    Contains("the rate of \"sqrt(t)\" is infinite at t = 0"));
}

// A bar at rest on a slider under a force that begins later: x = F (t - 1)^4/12 m; nothing measures the first steps.
// Of F sin(w t), begun at 1.0037 or at the start, x = F (T - sin(w T)/w)/(m w), whatever the step at rest.
TEST_CASE("adaptive steps of a motion that rests until a load begins") {
  const auto moved = [](const std::string& by, const char* step, const char* end = "3",
                        const char* tolerance = "1e-5") {
    return move(fill(R"yaml(
bodies: {b: {rigid: {mass: 2, centre: [0, 0], inertia: 1}}}
joints: {g: {type: prismatic, between: [ground, b.centre]}}
loads: {f: {type: force, at: b.centre, force: ["$force", 0]}}
motion: {end: $end, step: $step, tolerance: $tolerance}
probes: {x: {at: b.centre, quantity: displacement}}
)yaml",
                     {{"force", by}, {"step", step}, {"end", end}, {"tolerance", tolerance}}),
                Formulation::nlffr)["x.x"]
        .back();
  };
  for (const std::string force : {"max(0, t - 1)^2", "t > 1 ? (t - 1)^2 : 0"})
    CHECK(moved(force, "1e-3") == Approx(16. / 24).epsilon(1e-3));
  const double w = 200, T = 3 - 1.0037;
  for (const char* step : {"1e-3", "2e-2"})
    CHECK(moved("t > 1.0037 ? 5*sin(200*(t - 1.0037)) : 0", step) ==
          Approx(5 * (T - std::sin(w * T) / w) / (2 * w)).epsilon(1e-2));
  for (const char* step : {"1e-3", "2e-2", "0.5"})
    CHECK(moved("5*sin(200*t)", step) == Approx(5 * (3 - std::sin(w * 3) / w) / (2 * w)).epsilon(1e-2));
  // A first attempt of thirteen periods: the distance that it goes counts until it ends, not for the rest of the
  // motion.
  const double v = 302.8, S = 1 - 0.418;
  CHECK(moved("t > 0.418 ? 5*sin(302.8*(t - 0.418)) : 0", "0.2787", "1", "1e-4") ==
        Approx(5 * (S - std::sin(v * S) / v) / (2 * v)).epsilon(2e-2));  // 4.5 % off where it counts on
}

// A parallelogram at rest: its equations are singular where all coordinates are zero, with its bars in line.
TEST_CASE("a mechanism that has not moved yet continues from a stored state, to the last bit") {
  const scene::Scene scene = scene::parse_scene(R"yaml(
bodies:
  c1: {rigid: true, mesh: {line: {from: [0, 0], to: [1, 0], elements: 2}}, section: {rhoA: 1}, initial: {angle: 1.2}}
  r:
    rigid: true
    mesh: {line: {from: [0, 0], to: [2, 0], elements: 2}}
    section: {rhoA: 1}
    initial: {position: ["cos(1.2)", "sin(1.2)"]}
  c2:
    rigid: true
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 2}}
    section: {rhoA: 1}
    initial: {position: [2, 0], angle: 1.2}
joints:
  a: {type: revolute, between: [ground, c1.start]}
  b: {type: revolute, between: [c1.end, r.start]}
  c: {type: revolute, between: [r.end, c2.end]}
  d: {type: revolute, between: [ground, c2.start]}
loads: {f: {type: force, at: r.start, force: ["t > 1 ? 5*sin(3*(t - 1)) : 0", 0]}}
motion: {end: 1.5, step: 1e-2, tolerance: 1e-5}
probes: {x: {at: r.start, quantity: displacement}}
)yaml",
                                                "scene");
  std::optional<solve::MotionState> kept;
  const auto moved = [&](const solve::MotionState* from) {
    const assembly::Model model = assembly::build(scene, Formulation::vm_md, PETSC_COMM_SELF);
    solve::Integration how{1.5, 1e-2, scene.motion.spectral_radius, 1e-5};
    how.kinks = assembly::kinks_of(scene, how.end);
    how.from = from;
    std::vector<double> numbers;
    solve::simulate(*model.system, how, model.U, model.V, [&](const solve::Instant& now) {
      if (!from && now.step == 20) kept = (*now.state)();
      if (now.step <= 20) return;
      const std::vector<double> values = assembly::probe_values(model, now.t, now.U, now.V);
      numbers.push_back(now.t);
      numbers.insert(numbers.end(), values.begin(), values.end());
    });
    return numbers;
  };
  const std::vector<double> whole = moved(nullptr);
  REQUIRE(kept);
  REQUIRE(whole.size() > 100);
  CHECK(moved(&*kept) == whole);
}
