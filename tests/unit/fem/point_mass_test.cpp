#include "floe/fem/point_mass.h"

#include <catch2/catch.hpp>

#include "differences.h"
#include "eigenvalues.h"
#include "floe/error.h"
#include "floe/fem/transform.h"
#include "spatial_beam_chain.h"

using namespace floe;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using testing::relative_error;

TEST_CASE("a point mass has its mass, centre and inertia, and the mass matrix of a rigid body") {
  const Vector3d node(0.4, -1, 2), offset(0.1, 0.3, -0.2);
  const double m = 2.5;
  const Vector3d moments =
      GENERATE(Vector3d(0.3, 0.4, 0.5), Vector3d(0.3, 0.3, 0.6), Vector3d(0, 0.2, 0.2), Vector3d(0, 0, 0));
  const Matrix3d Q = testing::some_rotation(), J = Q * moments.asDiagonal() * Q.transpose();
  const fem::ElementMaps maps = fem::point_mass(node, m, J, offset);
  const body::Inertia in = fem::inertia(maps, MatrixXd::Identity(6, 6));
  CHECK(in.m == Approx(m).epsilon(1e-14));
  CHECK(relative_error(in.s0, m * (node + offset)) < 1e-14);
  const Vector3d c = node + offset;
  const Matrix3d C0 = m * c * c.transpose() + J.trace() / 2 * Matrix3d::Identity() - J;
  CHECK(relative_error(in.C0, C0) < 1e-13);
  // M = T' diag(m I, J) T from the centre to the node
  MatrixXd centre = MatrixXd::Zero(6, 6);
  centre.topLeftCorner<3, 3>() = m * Matrix3d::Identity();
  centre.bottomRightCorner<3, 3>() = J;
  CHECK(relative_error(maps.mass_matrix(), fem::rigid_arm(offset).transpose() * centre * fem::rigid_arm(offset)) <
        1e-13);
  CHECK(maps.stiffness().norm() == 0);
}

TEST_CASE("a beam's tip mass: frequency of a light cantilever is sqrt(3 EI / (m L^3))") {
  const double EI = 7, m = 2, L = 1.5;
  testing::BeamChain chain = testing::beam_chain(1, L, {1e6, EI, EI, 0, 1e3, 0, 0, 0, 0}, testing::clamped_root);
  const MatrixXd M = fem::point_mass({L, 0, 0}, m, Matrix3d::Zero()).mass_matrix();
  const MatrixXd K = testing::chain_stiffness(chain);
  const Eigen::VectorXd lambda = testing::eigenvalues(M, K);
  CHECK(1 / lambda[5] == Approx(3 * EI / (m * L * L * L)).epsilon(1e-12));
}

TEST_CASE("point masses that no body has are input errors") {
  const Vector3d o(0, 0, 0);
  CHECK_THROWS_AS(fem::point_mass(o, 0, Matrix3d::Zero()), InputError);
  CHECK_THROWS_AS(fem::point_mass(o, -1, Matrix3d::Zero()), InputError);
  CHECK_THROWS_AS(fem::point_mass(o, 1, Vector3d(1, 1, 2.1).asDiagonal()), InputError);  // 1 + 1 < 2.1
  Matrix3d skew = Matrix3d::Identity();
  skew(0, 1) = 0.3;
  CHECK_THROWS_AS(fem::point_mass(o, 1, skew), InputError);
}
