#include "floe/dynamics/floating_body.h"

#include <catch2/catch.hpp>

#include "terms.h"

using namespace floe;
using dynamics::FloatingBody;
using Eigen::VectorXd;
using testing::Random;
using testing::State;

namespace {

constexpr int k = 3;

body::PlanarInertia inertia() {
  Random random(121);
  body::Inertia sum(2, k);
  for (int i = 0; i < 9; ++i) sum.add({1.5 + random.number(), random.vector(2), 0.4 * random.matrix(2, k)});
  return body::planar(sum);
}

body::Elasticity elasticity() {
  Random random(122);
  const Eigen::MatrixXd root = random.matrix(k, k);
  return {root.transpose() * root, random.matrix(5, k + 3), {{0, 0}, {0, 2}, {2, 2}}};
}

FloatingBody body_with(const Eigen::MatrixXd& damping = {}) {
  return {{0, 1, 2, 3, 4, 5}, inertia(), elasticity(), damping};
}

double lagrangian(const FloatingBody& body, const VectorXd& q, const VectorXd& v) {
  const dynamics::Energy energy = body.energy({0, q, v, v});
  return energy.kinetic - energy.elastic;
}

}  // namespace

TEST_CASE("residual of a floating body = d/dt(dT/dv) - dT/dq + dU/dq") {
  const FloatingBody body = body_with();
  Random random(123);
  for (int i = 0; i < 3; ++i) {
    const State s(random, k + 3);
    const auto momentum = [&](double t) {
      const VectorXd q = s.q + t * s.v + t * t / 2 * s.a;
      return testing::gradient([&](const VectorXd& v) { return lagrangian(body, q, v); }, s.v + t * s.a, 0.1);
    };
    const auto at = [&](const VectorXd& q) { return lagrangian(body, q, s.v); };
    const VectorXd expected = testing::derivative(momentum, 0, 1e-3) - testing::gradient(at, s.q, 1e-3);
    CHECK(testing::relative_error(testing::rows_of(body, s), expected) < 1e-9);
  }
}

TEST_CASE("floating body tangents are the differences of the residual, damping included") {
  const Eigen::MatrixXd damping = GENERATE(Eigen::MatrixXd(), Eigen::MatrixXd(Random(124).matrix(k, k)));
  const FloatingBody body = body_with(damping);
  Random random(125);
  for (int i = 0; i < 3; ++i) CHECK(testing::tangent_error(body, State(random, k + 3)) < 1e-9);
}

TEST_CASE("damping adds D q' to the elastic rows and nothing to the frame's") {
  const Eigen::MatrixXd D = Random(126).matrix(k, k);
  Random random(127);
  const State s(random, k + 3);
  const VectorXd more = testing::rows_of(body_with(D), s) - testing::rows_of(body_with(), s);
  CHECK(more.head<3>().norm() == 0);
  CHECK((more.tail(k) - D * s.v.tail(k)).norm() < 1e-13);
}

TEST_CASE("a rigid body: m R'' and the moment of inertia about the frame's origin") {
  body::PlanarInertia in = body::planar(body::Inertia(2, 0));
  in.m = 2, in.C0 = 5;  // mass centre at the origin
  const FloatingBody rigid({0, 1, 2}, in, {Eigen::MatrixXd(0, 0), Eigen::MatrixXd(0, 0), {}});
  Random random(128);
  const State s(random, 3);
  CHECK((testing::rows_of(rigid, s) - Eigen::Vector3d(2 * s.a[0], 2 * s.a[1], 5 * s.a[2])).norm() < 1e-14);
  CHECK(rigid.energy({0, s.q, s.v, s.a}).kinetic ==
        Approx(0.5 * (2 * s.v.head<2>().squaredNorm() + 5 * s.v[2] * s.v[2])).epsilon(1e-14));
}
