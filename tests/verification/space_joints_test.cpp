#include <catch2/catch.hpp>

#include "space_twin.h"

using namespace floe;
using namespace floe::test;

// One rigid body on one joint, springs or dampers, all of it rotated; closed forms. A rod of side b, length 1, mass 1
// has moments m/12 (1 + b^2) across and m b^2/6 along; a cube of side a, mass 1, a^2/6.

namespace {

const Rotated rotation;

/// $z, $x, $y: rotated axes, $turn: the rotation vector.
History moved(const std::string& text, Words words = {}) {
  for (const auto& [name, axis] :
       {std::pair("x", rotation(1, 0, 0)), {"y", rotation(0, 1, 0)}, {"z", rotation(0, 0, 1)}})
    words.push_back({name, axis});
  words.push_back({"turn", rotation.text()});
  return move(fill(text, words), Formulation::vm_md);
}

Eigen::Vector3d back(const History& at, const std::string& probe, std::size_t i) {
  return rotation.Q.transpose() * vector_at(at, probe, i);
}

/// A cube of side 0.2 and mass 1 about its middle: I = 1/150.
const std::string cube = R"yaml(
  cube:
    rigid: true
    mesh: {line: {from: [-0.1, 0, 0], to: [0.1, 0, 0], elements: 2}}
    section: {shape: rectangle, width: 0.2, height: 0.2, orientation: [0, 1, 0]}
    material: {E: 1, nu: 0.3, rho: 125}
)yaml";

}  // namespace

// x = 1 + 0.1 e^(-c t/2m) (cos w t + c/(2m w) sin w t), w^2 = k/m - (c/2m)^2; on a cylinder it spins steadily.
TEST_CASE("joints in space: a mass on a spring along a rotating or fixed guide") {
  for (const std::string guide : {"prismatic", "cylindrical"}) {
    const History at = moved("bodies:" + cube + R"yaml(
    initial: {position: $place, rotation: $turn, angular_velocity: $spin}
joints:
  guide: {type: $guide, between: [ground, cube.middle], axis: $x}
  spring: {type: spring, between: [{body: ground, node: [0, 0, 0]}, cube.middle], stiffness: 25, viscosity: 0.6, length: 1}
motion: {end: 2, step: 2e-3}
probes: {cube: {at: cube.middle, quantity: position}, turn: {at: cube.middle, quantity: rotation}}
)yaml",
                             {{"place", rotation(1.1, 0)},
                              {"spin", guide == "prismatic" ? "[0, 0, 0]" : rotation(0.7, 0)},
                              {"guide", guide}});
    const double decay = 0.3, w = std::sqrt(25 - decay * decay);
    for (std::size_t i = 0; i < at.t.size(); ++i) {
      const double t = at.t[i], x = 1 + 0.1 * std::exp(-decay * t) * (std::cos(w * t) + decay / w * std::sin(w * t));
      CHECK((back(at, "cube", i) - Eigen::Vector3d(x, 0, 0)).norm() < 2e-5);
      const Eigen::Vector3d rotated(at["turn.rx"][i], at["turn.ry"][i], at["turn.rz"][i]);
      CHECK((rotation.Q.transpose() * rotated - Eigen::Vector3d(guide == "prismatic" ? 0 : 0.7 * t, 0, 0)).norm() <
            1e-9);
    }
  }
}

// Slides as a free body in its plane, rotates steadily about the normal; weight along the normal is carried.
TEST_CASE("joints in space: a cube on a plane moves as a free one in the plane") {
  const History at = moved("gravity: $g\nbodies:" + cube + R"yaml(
    initial: {rotation: $turn, velocity: $v, angular_velocity: $w}
joints: {floor: {type: planar, between: [ground, cube.middle], axis: $z}}
motion: {end: 1, step: 5e-3}
probes: {cube: {at: cube.middle, quantity: position}, turn: {at: cube.middle, quantity: rotation}}
)yaml",
                           {{"g", rotation(0, -2, -5)}, {"v", rotation(0.4, 0.9)}, {"w", rotation(0, 0, 2)}});
  for (std::size_t i = 0; i < at.t.size(); ++i) {
    const double t = at.t[i];
    CHECK((back(at, "cube", i) - Eigen::Vector3d(0.4 * t, 0.9 * t - t * t, 0)).norm() < 1e-9);
    const Eigen::Vector3d rotated(at["turn.rx"][i], at["turn.ry"][i], at["turn.rz"][i]);
    CHECK((rotation.Q.transpose() * rotated - Eigen::Vector3d(0, 0, 2 * t)).norm() < 1e-9);
  }
}

// The cube's middle is a spherical pendulum. Steady on a cone of half angle c:
// W^2 = g / (l cos c).
TEST_CASE("joints in space: a mass at a fixed distance moves as a conical pendulum") {
  const double c = 0.5, l = 0.8, g = 9.81, W = std::sqrt(g / (l * std::cos(c))), r = l * std::sin(c);
  const History at =
      moved("gravity: $g\nbodies:" + cube + R"yaml(
    initial: {position: $place, velocity: $v}
joints: {thread: {type: distance, between: [{body: ground, node: [0, 0, 0]}, cube.middle]}}
motion: {end: 2, step: 2e-3}
probes: {cube: {at: cube.middle, quantity: position}}
)yaml",
            {{"g", rotation(0, 0, -g)}, {"place", rotation(r, 0, -l * std::cos(c))}, {"v", rotation(0, r * W)}});
  for (std::size_t i = 0; i < at.t.size(); ++i) {
    const Eigen::Vector3d p = back(at, "cube", i);
    CHECK(p.norm() == Approx(l).epsilon(1e-10));
    CHECK((p - Eigen::Vector3d(r * std::cos(W * at.t[i]), r * std::sin(W * at.t[i]), -l * std::cos(c))).norm() < 1e-4);
  }
  CHECK(drift(at) < 1e-5);
}

// Position prescribed along the axis; the force that moves the cube does work, nothing else moves.
TEST_CASE("joints in space: a driven slide follows its function of time") {
  const History at = moved("bodies:" + cube + R"yaml(
    initial: {rotation: $turn}
joints: {slide: {type: driven_slide, between: [ground, cube.middle], axis: $y, position: "0.3*(1 - cos(5*t))"}}
motion: {end: 1, step: 5e-3}
probes: {cube: {at: cube.middle, quantity: position}}
)yaml");
  for (std::size_t i = 0; i < at.t.size(); ++i)
    CHECK((back(at, "cube", i) - Eigen::Vector3d(0, 0.3 * (1 - std::cos(5 * at.t[i])), 0)).norm() < 1e-12);
}

// Axes x, y, z of a bushing are the world's: small motions are six oscillators, w^2 = k/m and k/I.
TEST_CASE("joints in space: a cube on a bushing oscillates in six directions with closed forms") {
  const History at = moved("bodies:" + cube + R"yaml(
    initial: {velocity: [1e-3, 2e-3, -1e-3], angular_velocity: [0.01, -0.02, 0.03]}
joints:
  mount: {type: bushing, between: [ground, cube.middle], translation: [4, 9, 16], rotation: [4/150, 9/150, 25/150],
          translation_viscosity: [0.4, 0, 0]}
motion: {end: 2, step: 2e-3}
probes: {cube: {at: cube.middle, quantity: position}, turn: {at: cube.middle, quantity: rotation}}
)yaml");
  for (std::size_t i = 0; i < at.t.size(); ++i) {
    const double t = at.t[i], w = std::sqrt(4 - 0.04);
    CHECK(at["cube.x"][i] == Approx(1e-3 * std::exp(-0.2 * t) * std::sin(w * t) / w).margin(1e-7));
    CHECK(at["cube.y"][i] == Approx(2e-3 * std::sin(3 * t) / 3).margin(1e-7));
    CHECK(at["cube.z"][i] == Approx(-1e-3 * std::sin(4 * t) / 4).margin(1e-7));
    // rotating is of second order in its amplitude
    CHECK(at["turn.rx"][i] == Approx(0.01 * std::sin(2 * t) / 2).margin(1e-4));
    CHECK(at["turn.ry"][i] == Approx(-0.02 * std::sin(3 * t) / 3).margin(1e-4));
    CHECK(at["turn.rz"][i] == Approx(0.03 * std::sin(5 * t) / 5).margin(1e-4));
  }
}

TEST_CASE("joints in space: a bushing in large skew motions conserves energy") {
  const auto lost = [](const std::string& step) {
    return drift(moved("bodies:" + cube + R"yaml(
    initial: {velocity: [0.3, 0.2, -0.5], angular_velocity: [2, -3, 1]}
joints: {mount: {type: bushing, between: [ground, cube.middle], translation: [4, 9, 16], rotation: [0.05, 0.1, 0.2]}}
motion: {end: 2, step: $step}
)yaml",
                       {{"step", step}}));
  };
  const double coarse = lost("4e-3"), fine = lost("2e-3");
  CHECK(coarse < 1e-3);
  CHECK(fine < coarse / 3.5);
}

// phi = (w0 / W) sin(W t), W^2 = k/I: 3.2 turns to either side. A twist known only up to whole turns would be caught
// half a turn out.
TEST_CASE("joints in space: a torsional spring is wound up by three rotations and unwinds") {
  const double k = 1. / 150, w0 = 20;  // k = I
  const History at = moved("bodies:" + cube + R"yaml(
    initial: {rotation: $turn, angular_velocity: $w}
joints:
  hinge: {type: revolute, between: [ground, cube.middle], axis: $z}
  spring: {type: spring, between: [ground, cube.middle], axis: $z, torsional_stiffness: 1/150}
motion: {end: 6, step: 2e-3}
probes: {tip: {at: cube.end, quantity: position}}
)yaml",
                           {{"w", rotation(0, 0, w0)}});
  double greatest = 0;
  for (std::size_t i = 0; i < at.t.size(); ++i) {
    const double phi = w0 * std::sin(at.t[i]);
    CHECK((back(at, "tip", i) - 0.1 * Eigen::Vector3d(std::cos(phi), std::sin(phi), 0)).norm() < 1e-4);
    CHECK(at.energy[i].elastic == Approx(0.5 * k * phi * phi).margin(1e-4 * k * w0 * w0));
    greatest = std::max(greatest, std::abs(phi));
  }
  CHECK(greatest / (2 * M_PI) > 3.1);
}
