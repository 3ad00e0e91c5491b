#include "floe/fem/node_spring.h"

#include <catch2/catch.hpp>

#include "differences.h"
#include "eigenvalues.h"
#include "floe/error.h"
#include "floe/fem/structure.h"
#include "spatial_beam_chain.h"

using namespace floe;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using testing::relative_error;

namespace {

const Vector3d a(0.3, -0.2, 1.1), b(1.1, 0.9, 0.4);

fem::NodeSpring some_spring() {
  fem::NodeSpring spring;
  spring.stiffness << 3, 5, 7, 11, 13, 17;
  spring.axes = testing::some_rotation();
  spring.at = 0.3;
  return spring;
}

/// Of both nodes, by the displacement of the body's origin and a rotation about it.
VectorXd rigid_motion(const Vector3d& u, const Vector3d& theta) {
  VectorXd q(12);
  q << u + theta.cross(a), theta, u + theta.cross(b), theta;
  return q;
}

}  // namespace

TEST_CASE("a spring between two nodes resists no rigid motion") {
  const MatrixXd K = fem::node_spring(a, b, some_spring()).stiffness();
  for (int i = 0; i < 3; ++i) {
    CHECK((K * rigid_motion(Vector3d::Unit(i), Vector3d::Zero())).norm() < 1e-13 * K.norm());
    CHECK((K * rigid_motion(Vector3d::Zero(), Vector3d::Unit(i))).norm() < 1e-13 * K.norm());
  }
  const Eigen::VectorXd lambda = testing::eigenvalues(K);
  CHECK(lambda[5] < 1e-12 * lambda[11]);
  CHECK(lambda[6] > 1e-3 * lambda[11]);
}

TEST_CASE("a spring's energy is that of the relative motion at its point, in its axes") {
  const fem::NodeSpring spring = some_spring();
  const MatrixXd K = fem::node_spring(a, b, spring).stiffness();
  VectorXd q(12);
  q << 0.1, -0.3, 0.2, 0.4, 0.1, -0.2, 0.7, 0.2, -0.1, 0.3, -0.5, 0.6;
  const Vector3d p = a + spring.at * (b - a);
  const Vector3d du =
      q.segment<3>(6) + q.segment<3>(9).cross(Vector3d(p - b)) - q.head<3>() - q.segment<3>(3).cross(Vector3d(p - a));
  const Vector3d u = spring.axes.transpose() * du, theta = spring.axes.transpose() * (q.tail<3>() - q.segment<3>(3));
  double energy = 0;
  for (int i = 0; i < 3; ++i)
    energy += (spring.stiffness[i] * u[i] * u[i] + spring.stiffness[3 + i] * theta[i] * theta[i]) / 2;
  CHECK(q.dot(K * q) / 2 == Approx(energy).epsilon(1e-13));
  CHECK(fem::node_spring(a, b, spring).mass_matrix().norm() == 0);
}

TEST_CASE("a spring in the axes of a frame has the stiffness of the same spring") {
  const Matrix3d R = testing::some_rotation();
  const auto moved = std::get<fem::NodeSpring>(fem::rotated(some_spring(), R));
  const MatrixXd K = fem::node_spring(R.transpose() * a, R.transpose() * b, moved).stiffness();
  const MatrixXd T = testing::rotation_dofs(R, 2);
  CHECK(relative_error(T * K * T.transpose(), fem::node_spring(a, b, some_spring()).stiffness()) < 1e-13);
}

TEST_CASE("springs of negative stiffness or skew axes are input errors") {
  fem::NodeSpring spring = some_spring();
  spring.stiffness[4] = -1;
  CHECK_THROWS_AS(fem::node_spring(a, b, spring), InputError);
  spring = some_spring();
  spring.axes.col(0) *= 2;
  CHECK_THROWS_AS(fem::node_spring(a, b, spring), InputError);
}
