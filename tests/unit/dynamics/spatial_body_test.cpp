#include "floe/dynamics/spatial_body.h"

#include <catch2/catch.hpp>

#include "terms.h"

using namespace floe;
using dynamics::SpatialBody;
using Eigen::Vector3d;
using Eigen::VectorXd;
using testing::Random;
using testing::State;

namespace {

constexpr int k = 3;

body::SpatialInertia inertia() {
  Random random(131);
  body::Inertia sum(3, k);
  for (int i = 0; i < 9; ++i) sum.add({1.5 + random.number(), random.vector(3), 0.4 * random.matrix(3, k)});
  return body::spatial(sum);
}

body::Elasticity elasticity() {
  Random random(132);
  const Eigen::MatrixXd root = random.matrix(k, k);
  return {root.transpose() * root, random.matrix(5, k + 3), {{0, 0}, {0, 2}, {2, 2}}};
}

std::shared_ptr<dynamics::Attitude> rotated() {
  return std::make_shared<dynamics::Attitude>(dynamics::Attitude{math::quaternion({0.4, -1.3, 2.0})});
}

SpatialBody body_with(const Eigen::MatrixXd& damping = {}) {
  return {{0, 1, 2, 3, 4, 5, 6, 7, 8}, rotated(), inertia(), elasticity(), damping};
}

}  // namespace

TEST_CASE("residual of a body in space: its power is the rate of its energy") {
  const SpatialBody body = body_with();
  Random random(133);
  const State s(random, k + 6);
  const Vector3d x = s.q.segment<3>(3);
  const auto energy = [&](double t) {  // x' = T^-1 omega along the motion; omega' = alpha
    VectorXd q = s.q + t * s.v, v = s.v + t * s.a;
    q.segment<3>(3) = x + t * math::rotation_tangent(x).lu().solve(Vector3d(s.v.segment<3>(3)));
    const dynamics::Energy e = body.energy({0, q, v, v});
    return e.kinetic + e.elastic;
  };
  CHECK(testing::rows_of(body, s).dot(s.v) == Approx(testing::derivative(energy, 0, 1e-3)).epsilon(1e-9));
}

TEST_CASE("tangents of a body in space are the differences of the residual, x not zero, damping included") {
  const Eigen::MatrixXd damping = GENERATE(Eigen::MatrixXd(), Eigen::MatrixXd(Random(134).matrix(k, k)));
  const SpatialBody body = body_with(damping);
  Random random(135);
  for (int i = 0; i < 3; ++i) CHECK(testing::tangent_error(body, State(random, k + 6)) < 1e-9);
}

TEST_CASE("a body in space: damping adds D e' to the elastic rows and nothing to the frame's") {
  const Eigen::MatrixXd D = Random(136).matrix(k, k);
  Random random(137);
  const State s(random, k + 6);
  const VectorXd more = testing::rows_of(body_with(D), s) - testing::rows_of(body_with(), s);
  CHECK(more.head<6>().norm() == 0);
  CHECK((more.tail(k) - D * s.v.tail(k)).norm() < 1e-13);
}

TEST_CASE("a rigid body in space: m R'' and Euler's equations about body axes") {
  body::Inertia sum(3, 0);
  sum.m = 2, sum.C0 = Vector3d(3, 2, 1).asDiagonal();  // mass centre at the origin; J = 3, 4, 5
  const SpatialBody rigid({0, 1, 2, 3, 4, 5}, rotated(), body::spatial(sum),
                          {Eigen::MatrixXd(0, 0), Eigen::MatrixXd(0, 0), {}});
  Random random(138);
  const State s(random, 6);
  const Vector3d J(3, 4, 5), w = s.v.tail<3>(), spin = J.asDiagonal() * w;
  VectorXd expected(6);
  expected << 2 * s.a.head<3>(), J.asDiagonal() * s.a.tail<3>() + w.cross(spin);
  CHECK((testing::rows_of(rigid, s) - expected).norm() < 1e-14);
  CHECK(testing::tangent_error(rigid, s) < 1e-9);
  const body::Momentum momentum = rigid.momentum({0, s.q, s.v, s.a});
  const Vector3d about_centre = rotated()->axes(s.q.tail<3>()) * spin;
  CHECK((momentum.linear - 2 * s.v.head<3>()).norm() < 1e-14);
  CHECK((momentum.angular - 2 * s.q.head<3>().cross(s.v.head<3>()) - about_centre).norm() < 1e-13);
}
