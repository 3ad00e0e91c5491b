#include <catch2/catch.hpp>

#include "space_twin.h"

using namespace floe;
using namespace floe::test;
using Eigen::Vector3d;

// Rods of square section, side b, length 1, mass 1: about the middle J1 = b^2/6 along, J = (1 + b^2)/12 across.

namespace {

const Rotated rotation;

double along(double b) { return b * b / 6; }
double across(double b) { return (1 + b * b) / 12; }

History top(double tilt, double precession, double spin, double b, const std::string& step) {
  const Vector3d axis(std::sin(tilt), 0, std::cos(tilt)), w = precession * Vector3d::UnitZ() + spin * axis;
  const double half = tilt - M_PI / 2;  // mesh x is rotated about y onto the axis
  return move(fill(R"yaml(
gravity: [0, 0, -9.81]
parameters: {b: $b}
bodies:
  top:
    rigid: true
    mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: 2}}
    section: {shape: rectangle, width: b, height: b, orientation: [0, 1, 0]}
    material: {E: 1, nu: 0.3, rho: 1/b^2}
    initial: {rotation: [0, $turn, 0], angular_velocity: [$wx, $wy, $wz]}
joints: {point: {type: spherical, between: [ground, top.start]}}
motion: {end: 1, step: $step}
probes: {tip: {at: top.end, quantity: position}}
)yaml",
                   {{"b", number(b)},
                    {"turn", number(half)},
                    {"wx", number(w.x())},
                    {"wy", number(w.y())},
                    {"wz", number(w.z())},
                    {"step", step}}),
              Formulation::vm_md);
}

}  // namespace

// Steady precession: J' W^2 cos(tilt) - J1 w1 W + m g l = 0, J' about the point, l to the middle, w1 = spin + W
// cos(tilt).
TEST_CASE("rigid in space: a heavy top precesses steadily at the rate of the closed form") {
  const double tilt = 0.6, W = 3, b = 0.6, J = across(b) + 0.25;
  const double w1 = (J * W * W * std::cos(tilt) + 9.81 / 2) / (along(b) * W);
  const auto error = [&](const std::string& step) {
    const History at = top(tilt, W, w1 - W * std::cos(tilt), b, step);
    double worst = 0;
    for (std::size_t i = 0; i < at.t.size(); ++i) {
      const Vector3d exact(std::sin(tilt) * std::cos(W * at.t[i]), std::sin(tilt) * std::sin(W * at.t[i]),
                           std::cos(tilt));
      worst = std::max(worst, (vector_at(at, "tip", i) - exact).norm());
    }
    return worst;
  };
  const double coarse = error("2e-3"), fine = error("1e-3");
  INFO(coarse << " " << fine);
  CHECK(fine < 5e-3);
  CHECK(coarse / fine == Approx(4).epsilon(0.1));
}

// Of two equal moments: the axis of the body goes round the momentum L at |L| / J while its inclination stays.
TEST_CASE("rigid in space: a torque-free rod precesses at the rate of the closed form") {
  const double b = 0.4, J1 = along(b), J = across(b);
  const Vector3d x = rotation.Q * Vector3d::UnitX(), L = rotation.Q * Vector3d(6 * J1, J, 0), pole = L.normalized();
  const History at = move(fill(R"yaml(
parameters: {b: 0.4}
bodies:
  rod:
    rigid: true
    mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: 2}}
    section: {shape: rectangle, width: b, height: b, orientation: [0, 1, 0]}
    material: {E: 1, nu: 0.3, rho: 1/b^2}
    initial: {rotation: $turn, angular_velocity: $w, velocity: $v}
motion: {end: 3, step: 2e-3}
probes: {start: {at: rod.start, quantity: position}, end: {at: rod.end, quantity: position}}
)yaml",
                               {{"turn", rotation.text()},
                                {"w", rotation(6, 1)},
                                {"v", rotation(0, 0, 0.5)}}),  // so that the middle rests: v = (1/2, 0, 0) x w
                          Formulation::vm_md);
  double worst = 0;
  for (std::size_t i = 0; i < at.t.size(); ++i) {
    const Eigen::AngleAxisd round(L.norm() / J * at.t[i], pole);
    worst = std::max(worst, (vector_at(at, "end", i) - vector_at(at, "start", i) - round * x).norm());
    const Vector3d middle = (vector_at(at, "start", i) + vector_at(at, "end", i)) / 2;
    CHECK((middle - rotation.Q * Vector3d(0.5, 0, 0)).norm() < 2e-4);
  }
  CHECK(worst < 5e-4);
  CHECK(drift(at) < 5e-5);
}

// Jacobi: a body of three moments that rotates about the middle one is unstable; energy and momentum hold all the same.
TEST_CASE("rigid in space: energy of a body that tumbles about its intermediate axis") {
  const auto lost = [](const std::string& step) {
    return drift(move(fill(R"yaml(
bodies:
  plate:
    rigid: true
    mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: 2}}
    section: {shape: rectangle, width: 0.7, height: 0.1, orientation: [0, 1, 0]}
    material: {E: 1, nu: 0.3, rho: 10}
    initial: {angular_velocity: [0.02, 5, 0.01], velocity: [1, 2, 3]}
motion: {end: 3, step: $step}
)yaml",
                           {{"step", step}}),
                      Formulation::vm_md));
  };
  const double coarse = lost("4e-3"), fine = lost("2e-3");
  INFO(coarse << " " << fine);
  CHECK(coarse < 1e-3);
  CHECK(fine < coarse / 3.5);
}

TEST_CASE("rigid in space: energy of a double pendulum on spherical joints") {
  const auto lost = [](const std::string& step) {
    return drift(move(fill(R"yaml(
gravity: [0, 0, -9.81]
bodies:
  upper:
    rigid: true
    mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: 1}}
    section: {shape: rectangle, width: 0.2, height: 0.1, orientation: [0, 1, 0]}
    material: {E: 1, nu: 0.3, rho: 50}
    initial: {angular_velocity: [0, 0, 2]}
  lower:
    rigid: true
    mesh: {line: {from: [1, 0, 0], to: [1, 0.6, -0.3], elements: 1}}
    section: {shape: rectangle, width: 0.1, height: 0.1, orientation: [1, 0, 0]}
    material: {E: 1, nu: 0.3, rho: 50}
    initial: {angular_velocity: [0, 0, 2]}
joints:
  shoulder: {type: spherical, between: [ground, upper.start]}
  elbow: {type: spherical, between: [upper.end, lower.start]}
motion: {end: 2, step: $step}
)yaml",
                           {{"step", step}}),
                      Formulation::vm_md));
  };
  const double coarse = lost("2e-3"), fine = lost("1e-3");
  INFO(coarse << " " << fine);
  CHECK(coarse < 2e-3);
  CHECK(fine < coarse / 3.5);
}
