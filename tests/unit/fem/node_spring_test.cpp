#include "floe/fem/node_spring.h"

#include <catch2/catch.hpp>

#include "differences.h"
#include "eigenvalues.h"
#include "floe/error.h"
#include "floe/fem/structure.h"
#include "floe/math/rotation.h"
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

namespace {

double energy(const fem::NodeSpring& spring, const VectorXd& q) {
  const body::Elasticity e = fem::elasticity(fem::node_spring(a, b, spring), MatrixXd::Identity(12, 12));
  return body::energy(e, q);
}

/// Of a bushing whose axes rotate with the first node, or of the line between the nodes, without approximation.
double exact_energy(const fem::NodeSpring& spring, const VectorXd& q) {
  const Vector3d x = a + q.head<3>(), y = b + q.segment<3>(6);
  if (spring.kind == mesh::SpringKind::line)
    return spring.stiffness[0] / 2 * std::pow((y - x).norm() - (b - a).norm(), 2);
  const Matrix3d R = math::rotation(q.segment<3>(3)), Q = math::rotation(q.tail<3>());
  const Vector3d p = x + R * (spring.at * (b - a)), r = y + Q * ((spring.at - 1) * (b - a));
  const Vector3d u = spring.axes.transpose() * R.transpose() * (r - p),
                 rho = spring.axes.transpose() * math::rotation_vector(Eigen::Quaterniond(Matrix3d(R.transpose() * Q)));
  return (spring.stiffness.head<3>().dot(u.cwiseAbs2()) + spring.stiffness.tail<3>().dot(rho.cwiseAbs2())) / 2;
}

}  // namespace

// Strains of second order: energies differ by the fourth order, and in rigid motions, without strains, by the sixth.
TEST_CASE("a spring's energy is that of moderate rotations, of its axes and arms or of its length") {
  fem::NodeSpring spring = some_spring();
  if (GENERATE(false, true)) {
    spring.stiffness << 3, 0, 0, 0, 0, 0;
    spring.axes.col(0) = (b - a).normalized();
    spring.axes.col(1) = spring.axes.col(0).unitOrthogonal();
    spring.axes.col(2) = spring.axes.col(0).cross(spring.axes.col(1));
    spring.kind = mesh::SpringKind::line;
  }
  VectorXd q(12);
  q << 0.1, -0.3, 0.2, 0.4, 0.1, -0.2, 0.7, 0.2, -0.1, 0.3, -0.5, 0.6;
  const auto off = [&](double size) { return std::abs(energy(spring, size * q) - exact_energy(spring, size * q)); };
  CHECK(off(1e-2) < 1e-3 * energy(spring, 1e-2 * q));
  CHECK(off(2e-2) / off(1e-2) == Approx(16).epsilon(0.1));
  const auto rigid = [&](double size) {
    const Vector3d theta = size * Vector3d(0.3, -0.8, 0.5), u(0.4, 0.1, -0.3);
    const Matrix3d R = math::rotation(theta);
    VectorXd moved(12);
    moved << u + R * a - a, theta, u + R * b - b, theta;
    return energy(spring, moved);
  };
  CHECK(rigid(0.2) / rigid(0.1) > 60);
  CHECK(rigid(0.1) < 1e-4 * energy(spring, 0.1 * q));
  spring.kind = mesh::SpringKind::linear;
  CHECK(energy(spring, 2 * q) == Approx(4 * energy(spring, q)).epsilon(1e-12));
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
