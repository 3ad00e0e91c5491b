#include "floe/dynamics/spatial_force.h"

#include <catch2/catch.hpp>

#include "floe/dynamics/joints.h"
#include "spatial_terms.h"

using namespace floe;
using dynamics::SpatialForce;
using dynamics::SpatialMarker;
using dynamics::Wrench;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;
using testing::Random;
using testing::State;

namespace {

Wrench push(double t) { return (Wrench() << 2 * t, -1 + t * t, 0.5, 0.7, -0.2 * t, 1.1).finished(); }

std::vector<SpatialMarker> markers() {
  Random random(221);
  SpatialMarker weighted = testing::spatial_marker(random, 0, testing::attitude(random), 3);
  weighted.mass = 2.5;
  return {testing::spatial_marker(random, 0, testing::attitude(random), 3), weighted,
          testing::still_marker(random, 0, 3)};
}

Eigen::Index size(const SpatialForce& force) { return static_cast<Eigen::Index>(force.coordinates().size()); }

SpatialForce::Axes any_axes() {
  return GENERATE(SpatialForce::Axes::world, SpatialForce::Axes::body, SpatialForce::Axes::place);
}

}  // namespace

TEST_CASE("spatial force tangents are the differences of the residual along the chart, in world, body and place axes") {
  const SpatialForce::Axes axes = any_axes();
  Random random(222);
  for (const SpatialMarker& marker : markers()) {
    const SpatialForce force(marker, push, axes);
    for (int i = 0; i < 2; ++i) CHECK(testing::tangent_error(force, State(random, size(force))) < 1e-8);
  }
}

TEST_CASE("forces in other axes: tangents are differences of the residual, in space and in the plane") {
  Random random(226);
  for (const SpatialMarker& marker : markers()) {
    const int n = static_cast<int>(marker.coordinates.size());
    const dynamics::MovingAxes axes{n, n + 3, testing::attitude(random)};
    const SpatialForce force(marker, push, axes);
    const State s(random, size(force));
    REQUIRE(s.q.size() == n + 6);
    CHECK(testing::tangent_error(force, s) < 1e-8);
    const Matrix3d A = axes.attitude->axes(s.q.segment<3>(n + 3));
    dynamics::SpatialPose at;
    dynamics::pose(marker, s.q.head(n), s.v.head(n), s.a.head(n), at);
    const Vector3d f = A * push(s.t).head<3>(), m = A * push(s.t).tail<3>();
    CHECK(-testing::rows_of(force, s).dot(s.v) == Approx(f.dot(at.velocity) + m.dot(at.spin)).epsilon(1e-12));
  }
  const auto flat = testing::framed_marker(random, 0);
  const int n = static_cast<int>(flat.coordinates.size());
  dynamics::MovingAxes axes{n, n + 2};
  axes.angle = 0.3;
  const dynamics::Force force(
      flat, [](double t) { return Vector3d(1 + t, -2, 0.4); }, axes);
  CHECK(testing::tangent_error(force, State(random, n + 1)) < 1e-8);
}

TEST_CASE("the power of a wrench is f.velocity + m.spin, with f and m turned as their axes say") {
  const SpatialForce::Axes axes = any_axes();
  Random random(223);
  for (const SpatialMarker& marker : markers()) {
    const SpatialForce force(marker, push, axes);
    const State s(random, size(force));
    dynamics::SpatialPose at;
    dynamics::pose(marker, s.q, s.v, s.a, at);
    const Matrix3d rotated = axes == SpatialForce::Axes::world  ? Matrix3d(Matrix3d::Identity())
                             : axes == SpatialForce::Axes::body ? at.A
                                                                : at.D;
    const Vector3d f = rotated * push(s.t).head<3>(), m = rotated * push(s.t).tail<3>();
    CHECK(-testing::rows_of(force, s).dot(s.v) == Approx(f.dot(at.velocity) + m.dot(at.spin)).epsilon(1e-12));
  }
}

TEST_CASE("weight in space spends its potential; other forces hold no energy") {
  Random random(224);
  for (const SpatialMarker& marker : markers()) {
    SpatialForce force(
        marker, [](double) { return (Wrench() << 0, 1, -9.81, 0, 0, 0).finished(); }, SpatialForce::Axes::world);
    const testing::SpatialMotion motion(random, size(force),
                                        marker.framed() ? std::vector<Eigen::Index>{0} : std::vector<Eigen::Index>{});
    const auto potential = [&](double t) {
      const State s = motion.state(t);
      return force.energy({s.t, s.q, s.v, s.a}).potential;
    };
    CHECK(potential(0.3) == 0);
    force.conservative = true;
    const State s = motion.state(0.3);
    CHECK(testing::rows_of(force, s).dot(s.v) == Approx(testing::derivative(potential, 0.3, 1e-3)).epsilon(1e-8));
  }
}

TEST_CASE("in the plane a spatial force is the planar one") {
  Random random(225);
  const auto flat = testing::framed_marker(random, 0);
  const SpatialMarker marker = testing::in_space(flat, std::make_shared<dynamics::Attitude>());
  const std::vector<int> where{0, 1, 5, 6, 7};
  const State s(random, 5), lifted = testing::in_space(s, where, 8);
  const auto compare = [&](dynamics::Force::Axes axes, SpatialForce::Axes in_space) {
    const dynamics::Force planar(
        flat, [](double t) { return Vector3d(1 + t, -2, 0.4); }, axes);
    const SpatialForce force(
        marker, [](double t) { return (Wrench() << 1 + t, -2, 0, 0, 0, 0.4).finished(); }, in_space);
    CHECK((testing::picked(testing::rows_of(force, lifted), where) - testing::rows_of(planar, s)).norm() < 1e-14);
    CHECK((testing::picked(testing::tangent_of(force, lifted, {2, 0, 0}), where) -
           testing::tangent_of(planar, s, {2, 0, 0}))
              .norm() < 1e-13);
  };
  compare(dynamics::Force::Axes::world, SpatialForce::Axes::world);
  compare(dynamics::Force::Axes::body, SpatialForce::Axes::body);
}
