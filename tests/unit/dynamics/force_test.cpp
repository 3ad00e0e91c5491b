#include <catch2/catch.hpp>

#include "floe/dynamics/joints.h"
#include "terms.h"

using namespace floe;
using dynamics::Force;
using dynamics::Marker;
using Eigen::Vector3d;
using Eigen::VectorXd;
using testing::Random;
using testing::State;

namespace {

Vector3d push(double t) { return {2 * t, -1 + t * t, 0.5}; }

std::vector<Marker> markers() {
  Random random(111);
  std::vector<Marker> all{testing::framed_marker(random, 0), testing::framed_marker(random, 0),
                          testing::node_marker(random, 0)};
  all[1].mass = 2.5;
  return all;
}

Eigen::Index size(const Force& force) { return static_cast<Eigen::Index>(force.coordinates().size()); }

Vector3d rate(const Marker& marker, const State& s) {
  dynamics::Pose pose;
  dynamics::pose(marker, s.q, s.v, s.a, pose);
  return pose.yd;
}

}  // namespace

TEST_CASE("force tangents are the differences of the residual, in world, body and place axes") {
  const Force::Axes axes = GENERATE(Force::Axes::world, Force::Axes::body, Force::Axes::place);
  Random random(112);
  for (const Marker& marker : markers()) {
    const Force force(marker, push, axes);
    CHECK(testing::tangent_error(force, State(random, size(force))) < 1e-9);
  }
}

TEST_CASE("the power of a force is f.p' + m angle', with f turned by the frame in body axes, by the place in its own") {
  const Force::Axes axes = GENERATE(Force::Axes::world, Force::Axes::body, Force::Axes::place);
  Random random(113);
  for (const Marker& marker : markers()) {
    const Force force(marker, push, axes);
    const State s(random, size(force));
    Vector3d f = push(s.t);
    if (axes == Force::Axes::body && marker.framed) f.head<2>() = Eigen::Rotation2Dd(s.q[2]) * f.head<2>();
    dynamics::Pose pose;
    dynamics::pose(marker, s.q, s.v, s.a, pose);
    if (axes == Force::Axes::place) f.head<2>() = Eigen::Rotation2Dd(pose.y[2]) * f.head<2>();
    CHECK(-testing::rows_of(force, s).dot(s.v) == Approx(f.dot(rate(marker, s))).epsilon(1e-12));
  }
}

TEST_CASE("a conservative force is the gradient of its potential; others hold no energy") {
  Random random(114);
  for (const Marker& marker : markers()) {
    Force force(
        marker, [](double) { return Vector3d(0, -9.81, 0); }, Force::Axes::world);
    const State s(random, size(force));
    const auto potential = [&](const VectorXd& q) { return force.energy({s.t, q, s.v, s.a}).potential; };
    CHECK(potential(s.q) == 0);
    force.conservative = true;
    CHECK(testing::relative_error(testing::rows_of(force, s), testing::gradient(potential, s.q, 1e-3)) < 1e-9);
  }
}
