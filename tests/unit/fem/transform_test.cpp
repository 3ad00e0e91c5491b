#include "floe/fem/transform.h"

#include <catch2/catch.hpp>

#include "differences.h"
#include "floe/error.h"
#include "floe/fem/shell.h"
#include "floe/fem/spatial_beam.h"
#include "random.h"

using namespace floe;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using testing::Random;
using testing::relative_error;

TEST_CASE("a rigid arm carries u + theta x arm, and forces back with their moment") {
  const Vector3d u(0.1, 0.2, -0.3), theta(0.4, -0.5, 0.6), arm(1, 2, -3), force(2, -1, 5), moment(0.3, 0.7, -0.2);
  const VectorXd q = fem::rigid_arm(arm) * (VectorXd(6) << u, theta).finished();
  CHECK((q.head<3>() - (u + theta.cross(arm))).norm() < 1e-15);
  CHECK((q.tail<3>() - theta).norm() == 0);
  const VectorXd f = fem::rigid_arm(arm).transpose() * (VectorXd(6) << force, moment).finished();
  CHECK((f.head<3>() - force).norm() == 0);
  CHECK((f.tail<3>() - (moment + arm.cross(force))).norm() < 1e-14);
  // in the plane: the same with arm and rotation in it
  const Vector3d flat = fem::rigid_arm(Eigen::Vector2d(1, 2)) * Vector3d(0.1, 0.2, 0.6);
  CHECK((flat - Vector3d(0.1 - 0.6 * 2, 0.2 + 0.6 * 1, 0.6)).norm() < 1e-15);
}

TEST_CASE("arms in a row are one arm") {
  const Vector3d a(1, 2, -3), b(0.5, -1, 2);
  CHECK(relative_error(fem::rigid_arm(a) * fem::rigid_arm(b), fem::rigid_arm(Vector3d(a + b))) < 1e-15);
}

TEST_CASE("an element on other dofs has the same energy, mass and derivative") {
  const auto strain = GENERATE(fem::MembraneStrain::averaged, fem::MembraneStrain::pointwise);
  const fem::BeamPlace place{{0.3, -0.2, 0.5}, {1.1, 0.4, 0.1}, {0.2, 0.9, 0.7}};
  const fem::ElementMaps maps = fem::spatial_beam(place, {50, 0.9, 0.7, 0.3, 0.4, 3, 0.25, 0.2, -0.08}, {strain});
  const MatrixXd T = Random(51).matrix(12, 7);
  const fem::ElementMaps other = fem::transformed(maps, T);
  const MatrixXd I = MatrixXd::Identity(12, 12), I7 = MatrixXd::Identity(7, 7);
  const VectorXd q = Random(52).vector(7), p = Random(53).vector(7);

  CHECK(body::energy(fem::elasticity(other, I7), q) ==
        Approx(body::energy(fem::elasticity(maps, I), T * q)).epsilon(1e-13));
  CHECK(relative_error(other.stiffness(), T.transpose() * maps.stiffness() * T) < 1e-13);
  CHECK(relative_error(other.mass_matrix(), T.transpose() * maps.mass_matrix() * T) < 1e-13);
  CHECK(relative_error(fem::stiffness_derivative(other, q, p),
                       T.transpose() * fem::stiffness_derivative(maps, T * q, T * p)) < 1e-13);
  const body::Inertia a = fem::inertia(maps, T), b = fem::inertia(other, I7);
  CHECK(a.m == b.m);
  CHECK(relative_error(b.C0, a.C0) < 1e-15);
  CHECK(relative_error(b.S, a.S) < 1e-14);
  CHECK(relative_error(b.h[0][2], a.h[0][2]) < 1e-13);
  CHECK(relative_error(b.M[0][1], a.M[0][1]) < 1e-13);
  CHECK_THROWS_AS(fem::transformed(maps, MatrixXd::Identity(6, 6)), InputError);
}

TEST_CASE("an element of a rigid region is not strained by a rotation, to second order") {
  const Vector3d nodes[] = {{0.2, -0.1, 0}, {1.3, 0.2, 0.1}, {0.5, 0.9, 0}}, independent_node(-0.4, 0.7, 1.1);
  fem::ShellSection section = fem::shell_section({{fem::isotropic(1e4, 0.3, 2), 0.1, 0}});
  section.strains = fem::Strains::second_order;
  const fem::ElementMaps maps = fem::shell_triangle({nodes[0], nodes[1], nodes[2]}, section);
  MatrixXd T(18, 6);
  std::vector<fem::RigidArm> arms;
  for (int i = 0; i < 3; ++i) {
    T.middleRows<6>(6 * i) = fem::rigid_arm(Vector3d(nodes[i] - independent_node));
    arms.push_back({6 * i, 3, nodes[i] - independent_node});
  }
  const VectorXd q = Random(54).vector(6);
  const auto membrane = [&](const fem::ElementMaps& of) {  // strains of the membrane, and drilling
    double square = 0;
    for (const std::size_t point : {0, 3}) {
      const fem::StrainPoint& g = of.membrane[point];
      square += (g.L * q + g.bilinear(g.G * q, g.G * q) / 2).squaredNorm();
    }
    return std::sqrt(square);
  };
  CHECK(membrane(fem::transformed(maps, T, arms)) < 1e-14);
  CHECK(membrane(fem::transformed(maps, T)) > 0.1);
}
