#include <catch2/catch.hpp>

#include "space_twin.h"

using namespace floe;
using namespace floe::test;

// A speed is integrated by the program: what it drives is where the integral in closed form is, at the end of every
// step.

namespace {

const std::string arm = R"yaml(
bodies:
  arm:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 8}}
    section: {EA: 1e6, EI: 20, rhoA: 1}
    frame: {type: clamped, at: start}
    reduction: {modes: 3}
joints: {motor: {type: driven, between: [ground, arm.start], $drive}}
motion: {end: 1, step: $step}
probes: {tip: {at: arm.end, quantity: deflection}, root: {at: arm.start, quantity: rotation}}
)yaml";

History driven(const std::string& drive, const std::string& step = "2e-3") {
  return move(fill(arm, {{"drive", drive}, {"step", step}}), Formulation::vm_md);
}

}  // namespace

TEST_CASE("driven by speed: no drift from the closed form, also of a formula without one in elementary functions") {
  const History at = driven("speed: \"4*exp(-9*(t - 0.5)^2)\"");
  for (std::size_t i = 0; i < at.t.size(); ++i)
    CHECK(at["root.angle"][i] ==
          Approx(4 * std::sqrt(M_PI) / 6 * (std::erf(3 * (at.t[i] - 0.5)) + std::erf(1.5))).margin(1e-10));
}

TEST_CASE("driven by speed: the same motion as by the angle, at order 2") {
  const History angle = driven("angle: \"0.5*(1 - cos(6*t))\""), speed = driven("speed: \"3*sin(6*t)\"");
  CHECK(relative_error(speed, angle, "tip.y") < 1e-6);
  const History fine = driven("speed: \"3*sin(6*t)\"", "2.5e-4");
  const double coarse = relative_error(driven("speed: \"3*sin(6*t)\"", "4e-3"), fine, "tip.y"),
               middle = relative_error(speed, fine, "tip.y");
  CHECK(coarse / middle == Approx(4).epsilon(0.15));
}

TEST_CASE("driven by speed in space: hinge and slide") {
  const Rotated rotation;
  const auto cube = [&](const std::string& joint) {
    return move(fill(R"yaml(
bodies:
  cube:
    rigid: true
    mesh: {line: {from: [-0.1, 0, 0], to: [0.1, 0, 0], elements: 2}}
    section: {shape: rectangle, width: 0.2, height: 0.2, orientation: [0, 1, 0]}
    material: {E: 1, nu: 0.3, rho: 125}
    initial: {rotation: $turn}
joints: {drive: {$joint, between: [ground, cube.middle], axis: $axis}}
motion: {end: 1, step: 5e-3}
probes: {middle: {at: cube.middle}, end: {at: cube.end, quantity: position}}
)yaml",
                     {{"turn", rotation.text()}, {"joint", joint}, {"axis", rotation(0, 0, 1)}}),
                Formulation::vm_md);
  };
  const History slide = cube("type: driven_slide, speed: \"0.6*sin(7*t)\""),
                hinge = cube("type: driven, speed: \"9 + 2*cos(5*t)\"");
  for (std::size_t i = 0; i < slide.t.size(); ++i) {
    const double t = slide.t[i], z = 0.6 / 7 * (1 - std::cos(7 * t)), phi = 9 * t + 0.4 * std::sin(5 * t);
    CHECK((rotation.Q.transpose() * vector_at(slide, "middle", i) - Eigen::Vector3d(0, 0, z)).norm() < 1e-11);
    CHECK((rotation.Q.transpose() * vector_at(hinge, "end", i) - 0.1 * Eigen::Vector3d(std::cos(phi), std::sin(phi), 0))
              .norm() < 1e-10);
  }
}
