// Equilibria of mechanisms: where a damped motion comes to rest, from wherever it starts.
#include <catch2/catch.hpp>

#include "scene_motion.h"

using namespace floe;
using namespace floe::test;

namespace {

std::string plane_pendulum(const std::string& angle, const std::string& more = "") {
  return fill(R"yaml(
gravity: [0, -9.81]
bodies:
  rod:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 8}}
    section: {A: 4e-4, I: 1.333e-8}
    material: {E: 7e10, rho: 2700}
    initial: {angle: $angle}
joints:
  hinge: {type: revolute, between: [ground, rod.start]$more}
motion: {end: 1, step: 1}
probes: {tip: {at: rod.end, quantity: position}, turn: {at: rod.start, quantity: rotation}}
)yaml",
              {{"angle", angle}, {"more", more}});
}

std::string space_pendulum(const std::string& angle) {
  return fill(R"yaml(
gravity: [0, -9.81, 0]
bodies:
  rod:
    mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: 8}}
    section: {shape: rectangle, width: 0.02, height: 0.02, orientation: [0, 0, 1]}
    material: {E: 7e10, nu: 0.3, rho: 2700}
    initial: {rotation: [0, 0, $angle]}
joints:
  hinge: {type: revolute, between: [ground, rod.start], axis: [0, 0, 1]}
motion: {end: 1, step: 1}
probes: {tip: {at: rod.end, quantity: position}}
)yaml",
              {{"angle", angle}});
}

/// The rod hangs; it stretches by rho g L^2/(2 E) = 1.9e-7.
void check_hangs(const History& at) {
  CHECK(std::abs(at["tip.x"][0]) < 1e-9);
  CHECK(at["tip.y"][0] == Approx(-1).epsilon(1e-6));
}

}  // namespace

TEST_CASE("equilibrium of a pendulum: it hangs down from any start below, in the plane and in space") {
  for (const auto formulation : {Formulation::nlffr, Formulation::vm_md, Formulation::cfr})
    for (const std::string angle : {"-3", "-1.2", "-0.3", "-0.1", "0", "0.001", "0.02", "0.3"}) {
      INFO(scene::name_of(formulation) << " from " << angle);
      check_hangs(rest(plane_pendulum(angle), formulation));
      if (formulation != Formulation::cfr) check_hangs(rest(space_pendulum(angle), formulation));
    }
}

TEST_CASE("equilibrium of a pendulum that falls on a stop: it leans on it, not beyond") {
  for (const auto formulation : {Formulation::nlffr, Formulation::vm_md, Formulation::cfr}) {
    const History at = rest(plane_pendulum("0", ", limits: {lower: -0.3, stiffness: 1e4, width: 1e-3}"), formulation);
    const double weight = 4e-4 * 2700 * 9.81;
    CHECK(at["turn.angle"][0] == Approx(-0.3 - 1e-3 / 2 - weight / 2 * std::cos(0.3) / 1e4).epsilon(1e-5));
  }
}

// Without load, and under one that is round-off of what the joints know of their places, the configuration is the
// start.
TEST_CASE("equilibrium of a plate on a bushing and an oblique hinge: no displacement without a load") {
  const std::string text = R"yaml(
bodies:
  p:
    mesh: {plate: {along: [1, 0, 0], across: [0, 0.5, 0], elements: [8, 4]}}
    section: {thickness: 0.005}
    material: {E: 2.1e11, nu: 0.3, rho: 7850}
    reduction: {modes: 4}
joints:
  a: {type: revolute, between: [ground, p.p1], axis: [0.6, 0.8, 0]}
  s: {type: bushing, between: [ground, p.p3], translation: [1e4, 1e4, 1e4], rotation: [100, 100, 100]}
loads: {f: {type: force, at: p.p2, force: [0, 0, "$load"]}}
motion: {end: 1, step: 1}
probes: {tip: {at: p.p2}}
)yaml";
  for (const auto formulation : {Formulation::nlffr, Formulation::vm_md}) {
    const History none = rest(fill(text, {{"load", "0"}}), formulation),
                  some = rest(fill(text, {{"load", "10*t"}}), formulation);
    CHECK(std::abs(none["tip.z"][0]) < 1e-15);
    CHECK(some["tip.z"][0] > 1e-3);
  }
}

// A bar of stiffness much below that of its springs: it moves by F / k in each.
TEST_CASE("equilibrium of a bar on stiff springs: F / k") {
  for (const std::string k : {"1e6", "1e7", "1e9"}) {
    const std::string text = fill(R"yaml(
bodies:
  b:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 4}}
    section: {A: 4e-4, I: 1.3e-8}
    material: {E: 7e10, rho: 2700}
joints:
  s1: {type: spring, between: [{body: ground, node: [0, -1]}, b.start], stiffness: $k}
  s2: {type: spring, between: [{body: ground, node: [1, -1]}, b.end], stiffness: $k}
  s3: {type: spring, between: [{body: ground, node: [-1, 0]}, b.start], stiffness: $k}
loads: {f: {type: force, at: b.end, force: [0, "10*t"]}}
motion: {end: 1, step: 1}
probes: {e: {at: b.end}}
)yaml",
                                  {{"k", k}});
    for (const auto formulation : {Formulation::nlffr, Formulation::vm_md, Formulation::cfr}) {
      INFO("k = " << k << ", " << scene::name_of(formulation));
      CHECK(rest(text, formulation)["e.y"][0] == Approx(10 / std::stod(k)).epsilon(1e-4));
    }
  }
}

// A stiff bar on soft springs, 100 lengths from the origin of its mesh: as at the origin.
TEST_CASE("equilibrium of a bar in the plane far from its mesh's origin") {
  const auto bar = [](const std::string& x, Formulation formulation) {
    const double at = std::stod(x);
    const History rested = rest(fill(R"yaml(
bodies:
  b:
    mesh: {line: {from: [$at, 30], to: [$end, 30], elements: 4}}
    section: {A: 4e-4, I: 1.3e-8}
    material: {E: 7e10, rho: 2700}
    frame: mean-axis
    reduction: {modes: 4}
joints:
  s1: {type: spring, between: [{body: ground, node: [$at, 29]}, b.start], stiffness: 100}
  s2: {type: spring, between: [{body: ground, node: [$end, 29]}, b.end], stiffness: 100}
  s3: {type: spring, between: [{body: ground, node: [$ahead, 30]}, b.start], stiffness: 100}
loads: {f: {type: force, at: b.end, force: ["1*t", "10*t"]}}
motion: {end: 1, step: 1}
probes: {e: {at: b.end}, r: {at: b.start, quantity: rotation}}
)yaml",
                                     {{"end", number(at + 1)}, {"ahead", number(at - 1)}, {"at", x}}),
                                formulation);
    return std::array{rested["e.x"][0], rested["e.y"][0], rested["r.angle"][0]};
  };
  for (const auto formulation : {Formulation::nlffr, Formulation::vm_md}) {
    const auto near = bar("0", formulation);
    CHECK(near[1] == Approx(0.0990465).epsilon(1e-5));  // the corotational elements' as well
    for (const std::string x : {"100", "10000"}) {
      const auto away = bar(x, formulation);
      for (int i = 0; i < 3; ++i) CHECK(away[i] == Approx(near[i]).epsilon(1e-7).margin(1e-9));
    }
  }
}
