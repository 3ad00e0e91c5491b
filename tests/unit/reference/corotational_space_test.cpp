#include <catch2/catch.hpp>

#include "floe/error.h"
#include "floe/math/rotation.h"
#include "floe/reference/surface_pressure.h"
#include "floe/solve/branch.h"
#include "scene_motion.h"
#include "spatial_terms.h"

using namespace floe;
using namespace floe::test;
using floe::testing::Random;
using floe::testing::State;

namespace {

/// The equilibrium at t = 1 as `floe static` finds it.
History follow(const std::string& text, int steps) {
  History history = history_of(text, Formulation::cfr);
  for (int i = 1; i <= steps; ++i)
    solve::follow_equilibrium(*history.model.system, double(i - 1) / steps, double(i) / steps, 1e-3, history.model.U,
                              history.model.V, [](const solve::BranchJump&, Vec, Vec) {});
  store(history, 1, history.model.U, history.model.V);
  return history;
}

std::vector<dynamics::SpatialMarker> places(Random& random, int count) {
  std::vector<dynamics::SpatialMarker> all;
  for (int i = 0; i < count; ++i) {
    all.push_back(floe::testing::spatial_marker(random, 6 * i, floe::testing::attitude(random), 0));
    all.back().coordinates.resize(6);
  }
  return all;
}

/// Two plates that meet at an edge, one of beams at their corner; joints and loads of many kinds.
const char* const mechanism = R"yaml(
gravity: [0, 0, -3]
bodies:
  hub: {rigid: true, mesh: {line: {from: [-1, 0, 0], to: [0, 0, 0], elements: 1}}, section: {A: 0.1, Iy: 1e-3, Iz: 1e-3, J: 1e-3, orientation: [0, 1, 0]}, material: {E: 1e6, nu: 0.3, rho: 100}}
  plate:
    mesh: {plate: {along: [1, 0, 0], across: [0, 0.5, 0], elements: [4, 3], cells: triangles}}
    section: {thickness: 0.02}
    material: {E: 1e8, nu: 0.3, rho: 1000}
    damping: {stiffness: 1e-3}
  rod:
    mesh: {line: {from: [1, 0, 0], to: [1.5, 0, 0.2], elements: 4}}
    section: {shape: circle, radius: 0.01, orientation: [0, 1, 0]}
    material: {E: 1e9, nu: 0.3, rho: 1000}
joints:
  axle: {type: revolute, axis: [0, 1, 0], between: [ground, hub.start]}
  weld: {type: fixed, between: [hub.end, {body: plate, node: [0, 0, 0]}]}
  ball: {type: spherical, between: [plate.p2, rod.start]}
  spring: {type: spring, between: [ground, rod.end], stiffness: 20, viscosity: 1}
  edge: {type: spring, between: [{body: ground, node: [0.5, 0.5, 2]}, plate.top], stiffness: 10}
loads:
  tip: {type: moment, at: plate.p3, moment: ["3*t", 0, 0], axes: place}
  own: {type: force, at: plate.p3, force: [0, "2*t", "t"], axes: body}
  line: {type: moment, at: plate.top, moment: [0, "t", 0], axes: place}
  air: {type: pressure, body: plate, pressure: "200*t"}
motion: {end: 0.1, step: 2e-3}
probes:
  tip: {at: rod.end}
  corner: {at: plate.p3}
  bent: {at: plate.p3, quantity: deflection}
  top: {at: plate.top, quantity: rotation}
)yaml";

/// A rod on a driven hinge, its mesh rotated at the start, bent by gravity and rotation.
const char* const boom = R"yaml(
gravity: [0, 0, -9.81]
bodies:
  boom:
    mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: 6}}
    section: {shape: rectangle, width: 0.02, height: 0.005, orientation: [0, 0, 1]}
    material: {E: 2e9, nu: 0.3, rho: 1200}
    frame: $frame
    initial: {position: [0.1, 0.2, 0.3], rotation: [0.3, -0.2, 0.5]}
joints: {root: {type: driven, between: [ground, boom.start], axis: [0, 0, 1], angle: "4*t^2"}}
motion: {end: 0.3, step: 5e-3}
probes:
  middle: {at: boom.middle, quantity: deflection}
  a: {at: boom.start, quantity: position}
  m: {at: boom.middle, quantity: position}
  b: {at: boom.end, quantity: position}
)yaml";

Eigen::Vector3d vector_of(const History& history, const std::string& probe, std::size_t i) {
  return {history[probe + ".x"][i], history[probe + ".y"][i], history[probe + ".z"][i]};
}

}  // namespace

TEST_CASE("corotational in space: deflections are from the clamped or pinned frame that follows from places") {
  using Eigen::Vector3d;
  const Vector3d X = Vector3d(0.5, 0, 0);
  const History clamped = move(fill(boom, {{"frame", "{type: clamped, at: start}"}}), Formulation::cfr);
  const History pinned = move(fill(boom, {{"frame", "{type: pinned, from: start, to: end}"}}), Formulation::cfr);
  const Eigen::Matrix3d start = math::rotation(Vector3d(0.3, -0.2, 0.5));
  REQUIRE(clamped.t.size() > 30);
  double maximum = 0;
  for (std::size_t i = 0; i < clamped.t.size(); ++i) {
    const Eigen::Matrix3d driven = math::rotation(Vector3d(0, 0, 4 * clamped.t[i] * clamped.t[i]));
    const Vector3d m = vector_of(clamped, "m", i) - vector_of(clamped, "a", i), d = vector_of(clamped, "middle", i);
    CHECK((start.transpose() * driven.transpose() * m - X - d).norm() < 1e-9);
    maximum = std::max(maximum, d.norm());
    const Vector3d a = vector_of(pinned, "a", i), chord = (vector_of(pinned, "b", i) - a).normalized(),
                   other = vector_of(pinned, "m", i) - a, e = vector_of(pinned, "middle", i);
    CHECK(e.x() == Approx(chord.dot(other) - 0.5).margin(1e-12));
    CHECK(e.tail<2>().norm() == Approx((other - chord.dot(other) * chord).norm()).margin(1e-12));
  }
  CHECK(maximum > 0.01);
}

TEST_CASE("pressure on a surface: the tangent is the difference of the residual; follower and dead",
          "[corotational-space]") {
  Random random(931);
  for (const auto& [kind, count] : {std::pair{mesh::CellKind::triangle, 3},
                                    {mesh::CellKind::quadrilateral, 4},
                                    {mesh::CellKind::triangle6, 6},
                                    {mesh::CellKind::quadrilateral8, 8}})
    for (const bool follower : {true, false}) {
      std::vector<Eigen::Vector3d> undeformed;
      for (int i = 0; i < count && !follower; ++i) undeformed.emplace_back(random.vector(3));
      const reference::SurfacePressure pressure(
          places(random, count), fem::surface_shapes(kind), [](double t) { return 2 + t; }, undeformed);
      CHECK(floe::testing::tangent_error(pressure, State(random, 6 * count)) < 1e-8);
    }
}

TEST_CASE("cfr in space: an end moment rolls beams and shells to circles on any number of ranks",
          "[corotational-space]") {
  const std::string scene =
      fill(R"yaml(
bodies:
  b:
    mesh: {$mesh}
    section: {$section}
    material: {E: $E, nu: 0, rho: 1}
joints: {clamp: {type: fixed, between: [ground, b.$start]}}
loads: {m: {type: moment, at: b.$end, moment: [0, "-2*pi*t", 0]}}
probes: {tip: {at: {body: b, node: [1, 0, 0]}}}
)yaml",
           GENERATE(Words{{"mesh", "line: {from: [0, 0, 0], to: [1, 0, 0], elements: 6}"},
                          {"section", "A: 1e4, Iy: 1, Iz: 1, J: 1, orientation: [0, 1, 0]"},
                          {"E", "1"},
                          {"start", "start"},
                          {"end", "end"}},
                    Words{{"mesh", "plate: {along: [1, 0, 0], across: [0, 0.1, 0], elements: [12, 1]}"},
                          {"section", "thickness: 0.01"},
                          {"E", "1.2e8"},
                          {"start", "left"},
                          {"end", "right"}}));
  const History at = follow(scene, 4);
  CHECK(at["tip.x"].back() == Approx(-1).margin(1e-3));
  CHECK(at["tip.z"].back() == Approx(0).margin(1e-3));
}

TEST_CASE("cfr in space: a mechanism of shells, beams and a rigid body moves alike on any number of ranks",
          "[corotational-space]") {
  const History at = move(mechanism, Formulation::cfr);
  const scene::Scene scene = scene::parse_scene(mechanism, "scene");
  assembly::Model alone = assembly::build(scene, Formulation::cfr, PETSC_COMM_SELF);
  solve::Integration how{scene.motion.end, scene.motion.step, scene.motion.spectral_radius, scene.motion.tolerance};
  std::vector<double> last;
  solve::simulate(*alone.system, how, alone.U, alone.V,
                  [&](const solve::Instant& now) { last = assembly::probe_values(alone, now.t, now.U, now.V); });
  const auto columns = assembly::probe_columns(at.model);
  double maximum = 0;
  for (std::size_t c = 0; c < columns.size(); ++c) {
    CHECK(at[columns[c].name].back() == Approx(last[c]).margin(1e-8));
    maximum = std::max(maximum, std::abs(last[c]));
  }
  CHECK(maximum > 1e-3);
}
