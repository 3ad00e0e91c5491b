#include <catch2/catch.hpp>
#include <cmath>

#include "building.h"
#include "floe/math/rotation.h"
#include "floe/solve/simulation.h"

using namespace floe;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using scene::Formulation;
using testing::at_start;
using testing::built;

namespace {

// A wheel that a joint drives about z through (1, 0, 0) at 2 rad/s, and a block that floats past it: the observer
// stands on the wheel's rim.
const char* text = R"yaml(
bodies:
  wheel:
    rigid: true
    mesh: {line: {from: [1, 0, 0], to: [1, 3, 0], elements: 1}}
    section: {shape: circle, radius: 0.1, orientation: [1, 0, 0]}
    material: {E: 1e9, nu: 0.3, rho: 1000}
    initial: {angular_velocity: [0, 0, 2]}
  block:
    rigid: true
    mesh: {line: {from: [0, 0, 0], to: [0, 0, 1], elements: 2}}
    section: {shape: rectangle, width: 0.2, height: 0.2, orientation: [1, 0, 0]}
    material: {E: 1e9, nu: 0.3, rho: 1000}
    initial: {position: [2, -1, 0.5], velocity: [0.3, 0.7, -0.2], angular_velocity: [0, 0, -0.6]}
joints:
  axle: {type: driven, between: [ground, wheel.start], axis: [0, 0, 1], angle: 2*t}
motion: {end: 0.4, step: 0.01}
probes:
  seen: {at: block.start, quantity: position, relative_to: wheel.end}
  moved: {at: block.start, quantity: displacement, relative_to: wheel.end}
  moving: {at: block.start, quantity: velocity, relative_to: wheel.end}
  turned: {at: block.start, quantity: rotation, relative_to: wheel.end}
)yaml";

Matrix3d about_z(double angle) { return Eigen::AngleAxisd(angle, Vector3d::UnitZ()).toRotationMatrix(); }

struct Seen {
  Vector3d p, v;
};

/// What an observer at the rim sees: p' = D^T (p - r), its rate D^T (v - r' - w x (p - r)), D = R_z(2 t).
Seen closed_form(double t) {
  const Vector3d spin(0, 0, 2), v(0.3, 0.7, -0.2), rim = about_z(2 * t) * Vector3d(0, 3, 0);
  const Vector3d apart = Vector3d(2, -1, 0.5) + v * t - (Vector3d(1, 0, 0) + rim);
  const Matrix3d Dt = about_z(-2 * t);
  return {Dt * apart, Dt * (v - spin.cross(rim) - spin.cross(apart))};
}

}  // namespace

TEST_CASE("space: a probe relative to a turning place is what an observer there sees, its velocity too") {
  assembly::Model model = built(text, Formulation::vm_md);
  const auto columns = assembly::probe_columns(model);
  REQUIRE(columns.size() == 12);
  CHECK((columns[2].name == "seen.z" && columns[6].name == "moving.x" && columns[6].unit == "m/s"));
  CHECK((columns[9].name == "turned.rx" && columns[9].unit == "rad"));
  const auto check = [&](double t, const std::vector<double>& values, double tolerance) {
    INFO("t = " << t);
    const Seen exact = closed_form(t);
    const auto value = [&](int probe) { return Eigen::Map<const Vector3d>(values.data() + 3 * probe); };
    CHECK((value(0) - exact.p).norm() < tolerance);
    CHECK((value(1) - (exact.p - closed_form(0).p)).norm() < tolerance);
    CHECK((value(2) - exact.v).norm() < tolerance);
    CHECK((value(3) - Vector3d(0, 0, -2.6 * t)).norm() < tolerance);  // -0.6 rad/s in the world
  };
  check(0, at_start(model), 1e-12);
  // steady rotations and a uniform motion: exact but for the solver's tolerance
  int rows = 0;
  solve::simulate(*model.system, {0.4, 0.01, 0.8, {}}, model.U, model.V, [&](const solve::Instant& now) {
    if (rows++ % 10 == 0) check(now.t, assembly::probe_values(model, now.t, now.U, now.V), 1e-7);
  });
  CHECK(rows == 41);
}

TEST_CASE("space: a probe relative to a place on a tilted body that spins about a tilted axis") {
  const Vector3d tilt(0.4, -0.3, 0.9), spin(1.5, -2, 0.7), v(0.2, 0.1, -0.4);
  assembly::Model model = built(R"yaml(
bodies:
  hub:
    rigid: true
    mesh: {line: {from: [0, 0, 0], to: [0, 0.5, 0], elements: 1}}
    section: {shape: circle, radius: 0.1, orientation: [1, 0, 0]}
    material: {E: 1e9, nu: 0.3, rho: 1000}
    initial: {rotation: [0.4, -0.3, 0.9], velocity: [0.2, 0.1, -0.4], angular_velocity: [1.5, -2, 0.7]}
  mast:
    rigid: true
    mesh: {line: {from: [0, 0, 0], to: [1, 2, 3], elements: 1}}
    section: {shape: circle, radius: 0.1, orientation: [1, 0, 0]}
    material: {E: 1e9, nu: 0.3, rho: 1000}
motion: {end: 1, step: 0.01}
probes:
  top: {at: mast.end, quantity: velocity, relative_to: hub.end}
)yaml",
                                Formulation::vm_md);
  const Vector3d end = math::rotation(tilt) * Vector3d(0, 0.5, 0);
  const auto values = at_start(model);
  REQUIRE(values.size() == 3);
  const Vector3d expected =
      -(v + spin.cross(end)) - spin.cross(Vector3d(1, 2, 3) - end);  // axes of the world at the start
  CHECK((Vector3d(values[0], values[1], values[2]) - expected).norm() < 1e-12);
}
