#include <catch2/catch.hpp>

#include "differences.h"
#include "eigenvalues.h"
#include "floe/error.h"
#include "floe/fem/shell.h"
#include "shell_states.h"

using namespace floe;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using testing::relative_error;

namespace {

const fem::QuadrilateralNodes warped{Vector3d(0, 0, 0), Vector3d(1.2, 0.1, 0.1), Vector3d(1.4, 1.1, -0.1),
                                     Vector3d(-0.1, 0.9, 0.2)};

double area(const Vector3d& a, const Vector3d& b, const Vector3d& c) { return (b - a).cross(c - a).norm() / 2; }

}  // namespace

TEST_CASE("shell quadrilateral, warped: rigid motions cost nothing, nothing else is free") {
  const MatrixXd K = fem::shell_quadrilateral_stiffness(warped, testing::aluminium(0.05));
  CHECK((K * testing::rigid_motions(warped)).cwiseAbs().maxCoeff() < 1e-12 * K.cwiseAbs().maxCoeff());
  const Eigen::VectorXd values = testing::eigenvalues(K) / K.trace();
  CHECK(values.head(6).cwiseAbs().maxCoeff() < 1e-14);
  CHECK(values[6] > 1e-7);
}

// Corners that rotate about axes in the surface bend it and do not drill: energy of the thickness cubed.
TEST_CASE("shell quadrilateral, warped: bending costs no drilling") {
  Eigen::VectorXd q = Eigen::VectorXd::Zero(24);
  for (int i = 0; i < 4; ++i) {
    const Vector3d next = warped[(i + 1) % 4] - warped[i], last = warped[(i + 3) % 4] - warped[i];
    q.segment<3>(6 * i + 3) = (i + 1) * next - (i * i - 2) * last;
  }
  const auto energy = [&](double thickness) {
    return q.dot(fem::shell_quadrilateral_stiffness(warped, testing::aluminium(thickness)) * q);
  };
  CHECK(energy(1e-3) / energy(1e-2) == Approx(1e-3).epsilon(1e-9));
}

TEST_CASE("shell quadrilateral: fast matrices are those of the maps") {
  const auto section = testing::skew_laminate();
  const fem::ElementMaps maps = fem::shell_quadrilateral(warped, section);
  CHECK(relative_error(fem::shell_quadrilateral_stiffness(warped, section), maps.stiffness()) < 1e-13);
  CHECK(relative_error(fem::shell_quadrilateral_mass(warped, section), maps.mass_matrix()) < 1e-13);
}

TEST_CASE("shell quadrilateral, warped: area, mass and volume are the means of the two folded surfaces") {
  const auto& n = warped;
  const double one = area(n[0], n[1], n[2]) + area(n[0], n[2], n[3]);
  const double two = area(n[0], n[1], n[3]) + area(n[1], n[2], n[3]);
  REQUIRE(std::abs(one - two) > 1e-5);
  const auto section = testing::aluminium(0.05);
  double mass = 0, surface = 0;
  for (const auto& p : fem::shell_quadrilateral(n, section).mass) mass += p.mass;
  Vector3d normals = Vector3d::Zero();
  for (const auto& p : fem::shell_quadrilateral_surface(n)) {
    surface += p.area;
    normals += p.area * p.normal;
  }
  CHECK(surface == Approx((one + two) / 2).epsilon(1e-13));
  CHECK(mass == Approx(section.mass * (one + two) / 2).epsilon(1e-13));
  // the vector area depends on the rim alone: half the cross product of the diagonals
  CHECK((normals - (n[2] - n[0]).cross(n[3] - n[1]) / 2).norm() < 1e-14);
}

TEST_CASE("shell quadrilateral: a corner that is not convex, nodes in the wrong order") {
  const auto section = testing::aluminium(0.05);
  CHECK_THROWS_AS(fem::shell_quadrilateral({warped[0], warped[1], Vector3d(0.1, 0.1, 0), warped[3]}, section),
                  InputError);
  CHECK_THROWS_AS(fem::shell_quadrilateral({warped[0], warped[2], warped[1], warped[3]}, section), InputError);
}
