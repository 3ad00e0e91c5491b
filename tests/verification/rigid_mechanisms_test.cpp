#include <catch2/catch.hpp>

#include "scene_motion.h"

using namespace floe;
using namespace floe::test;

// x.. = -k/m x with x(0) = 0.1: x = 0.1 cos(sqrt(k/m) t).
TEST_CASE("rigid mechanisms: mass on a spring") {
  const History at = move(R"yaml(
bodies:
  mass:
    rigid: true
    mesh: {line: {from: [-0.1, 0], to: [0.1, 0], elements: 2}}
    section: {rhoA: 10}
    initial: {position: [1.1, 0]}
joints:
  guide: {type: prismatic, between: [ground, mass.middle], axis: [1, 0]}
  spring: {type: spring, between: [{body: ground, node: [0, 0]}, mass.middle], stiffness: 50, length: 1}
motion: {end: 4, step: 2e-3}
probes: {mass: {at: mass.middle, quantity: position}}
)yaml",
                          Formulation::vm_md);
  for (std::size_t i = 0; i < at.t.size(); ++i) {
    CHECK(at["mass.x"][i] == Approx(1 + 0.1 * std::cos(5 * at.t[i])).margin(2e-5));
    CHECK(std::abs(at["mass.y"][i]) < 1e-12);
  }
}

// Viscous: x = 0.1 e^(-z w t) (cos wd t + z w / wd sin wd t), z w = c / 2m.
TEST_CASE("rigid mechanisms: damped mass along a tilted guide") {
  const History at = move(R"yaml(
bodies:
  mass:
    rigid: true
    mesh: {line: {from: [-0.1, 0], to: [0.1, 0], elements: 2}}
    section: {rhoA: 10}
    initial: {position: [1.1*0.6, 1.1*0.8], angle: 0.3}
joints:
  guide: {type: prismatic, between: [ground, mass.middle], axis: [0.6, 0.8]}
  spring: {type: spring, between: [{body: ground, node: [0, 0]}, mass.middle], stiffness: 50, viscosity: 2, length: 1}
motion: {end: 4, step: 2e-3}
probes: {mass: {at: mass.middle, quantity: position}, turn: {at: mass.middle, quantity: rotation}}
)yaml",
                          Formulation::vm_md);
  const double decay = 0.5, w = std::sqrt(25 - decay * decay);
  for (std::size_t i = 0; i < at.t.size(); ++i) {
    const double t = at.t[i], x = 1 + 0.1 * std::exp(-decay * t) * (std::cos(w * t) + decay / w * std::sin(w * t));
    CHECK(at["mass.x"][i] == Approx(0.6 * x).margin(2e-5));
    CHECK(at["mass.y"][i] == Approx(0.8 * x).margin(2e-5));
    CHECK(std::abs(at["turn.angle"][i]) < 1e-12);
  }
}

// Torsional spring on a hinged rod: omega^2 = 3 k / (m L^2).
TEST_CASE("rigid mechanisms: rod on a torsional spring") {
  const History at = move(R"yaml(
bodies:
  rod:
    rigid: true
    mesh: {line: {from: [0, 0], to: [2, 0], elements: 1}}
    section: {rhoA: 1.5}
    initial: {angular_velocity: 0.2}
joints:
  hinge: {type: revolute, between: [ground, rod.start]}
  spring: {type: spring, between: [ground, rod.start], torsional_stiffness: 16}
motion: {end: 4, step: 2e-3}
probes: {turn: {at: rod.end, quantity: rotation}}
)yaml",
                          Formulation::vm_md);
  for (std::size_t i = 0; i < at.t.size(); ++i)
    CHECK(at["turn.angle"][i] == Approx(0.1 * std::sin(2 * at.t[i])).margin(2e-5));
}

namespace {

/// A rod of mass m = 1, L = 1 hung from a slider of mass M = 2 that runs along x without friction.
History hanging(double tilt) {
  return move(fill(R"yaml(
gravity: [0, -9.81]
bodies:
  slider:
    rigid: true
    mesh: {line: {from: [-0.1, 0], to: [0.1, 0], elements: 2}}
    section: {rhoA: 10}
  rod:
    rigid: true
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 2}}
    section: {rhoA: 1}
    initial: {angle: -pi/2 + $tilt}
joints:
  guide: {type: prismatic, between: [ground, slider.middle], axis: [1, 0]}
  hinge: {type: revolute, between: [slider.middle, rod.start]}
motion: {end: 3, step: 1e-3}
probes:
  slider: {at: slider.middle, quantity: position}
  centre: {at: rod.middle, quantity: position}
  turn: {at: rod.end, quantity: rotation}
)yaml",
                   {{"tilt", number(tilt)}}),
              Formulation::vm_md);
}

}  // namespace

// Small: omega^2 = m g L/2 / (m L^2/3 - (m L/2)^2 / (M + m)).
TEST_CASE("rigid mechanisms: small oscillation of a pendulum on a slider") {
  const History at = hanging(1e-3);
  const double omega = std::sqrt(9.81 / 2 / (1. / 3 - 0.25 / 3));
  for (std::size_t i = 0; i < at.t.size(); ++i)
    CHECK(1e-3 + at["turn.angle"][i] == Approx(1e-3 * std::cos(omega * at.t[i])).margin(1e-3 * 2e-3));
}

// Large: no force along x keeps the centre of mass where it was, the energy gives the speed in the lowest place:
// (1/2) theta.^2 (m L^2/3 - (m L/2)^2/(M+m)) = m g L/2 (1 - cos tilt).
TEST_CASE("rigid mechanisms: large oscillation of a pendulum on a slider") {
  const double tilt = 2;
  const History at = hanging(tilt);
  const double centre = 2 * at["slider.x"][0] + at["centre.x"][0];
  for (std::size_t i = 0; i < at.t.size(); ++i)
    CHECK(2 * at["slider.x"][i] + at["centre.x"][i] == Approx(centre).margin(1e-9));
  std::size_t lowest = 0;  // the first passage
  while (tilt + at["turn.angle"][lowest] > 0) ++lowest;
  const double rate = (at["turn.angle"][lowest] - at["turn.angle"][lowest - 1]) / 1e-3;
  CHECK(rate == Approx(-std::sqrt(9.81 * (1 - std::cos(tilt)) / (1. / 3 - 0.25 / 3))).epsilon(1e-4));
}

// Pendulum of any amplitude: the first passage is after a quarter of the period 4 K(sin(a/2)) / omega_0.
TEST_CASE("rigid mechanisms: period of a pendulum at large amplitude") {
  const History at = move(R"yaml(
gravity: [0, -9.81]
bodies:
  rod:
    rigid: true
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 1}}
    section: {rhoA: 1}
joints: {hinge: {type: revolute, between: [ground, rod.start]}}
motion: {end: 2, step: 1e-3}
probes: {tip: {at: rod.end, quantity: position}}
)yaml",
                          Formulation::vm_md);
  const auto zero = at.crossings("tip.x");
  REQUIRE(zero.size() >= 2);
  const double quarter = std::comp_ellint_1(std::sin(M_PI / 4)) / std::sqrt(1.5 * 9.81);
  CHECK(zero[0] == Approx(quarter).epsilon(2e-5));
  CHECK(zero[1] == Approx(3 * quarter).epsilon(2e-5));
}
