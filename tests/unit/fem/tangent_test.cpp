#include <catch2/catch.hpp>

#include "differences.h"
#include "floe/fem/assembly.h"
#include "floe/fem/shell.h"
#include "floe/fem/transform.h"
#include "random.h"
#include "shell_states.h"

using namespace floe;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using testing::relative_error;

namespace {

/// dU/dq of an element.
VectorXd force(const fem::ElementMaps& maps, const VectorXd& q) {
  const body::Elasticity elastic = fem::elasticity(maps, MatrixXd::Identity(q.size(), q.size()));
  return testing::gradient([&](const VectorXd& x) { return body::energy(elastic, x); }, q, 1e-3);
}

void check_tangent(const fem::ElementMaps& maps, double size) {
  const VectorXd q = size * testing::Random(7).vector(maps.bending.rows());
  const MatrixXd found = maps.tangent(q);
  CHECK(relative_error(found, testing::jacobian([&](const VectorXd& x) { return force(maps, x); }, q, 1e-3)) < 1e-7);
  const body::Elasticity elastic = fem::elasticity(maps, MatrixXd::Identity(q.size(), q.size()));
  const auto reduced = [&](const VectorXd& x) {
    VectorXd f = VectorXd::Zero(x.size());
    body::ElasticityWork work;
    body::add_force(elastic, x, work, f);
    return f;
  };
  CHECK(relative_error(found, testing::jacobian(reduced, q, 1e-3)) < 1e-8);  // exact for cubics but for round-off
  CHECK(relative_error(reduced(q), force(maps, q)) < 1e-10);                 // power: f'v = dU/dt at every rate v
  const VectorXd p = testing::Random(8).vector(q.size()), r = testing::Random(9).vector(q.size());
  const auto along = [&](const VectorXd& s) { return VectorXd(maps.tangent(s[0] * p) * r); };
  CHECK(relative_error(fem::stiffness_derivative(maps, p, r),
                       VectorXd(testing::jacobian(along, VectorXd::Zero(1), 1e-3))) < 1e-8);
  CHECK(relative_error(found, found.transpose().eval()) < 1e-14);
  CHECK(relative_error(maps.tangent(VectorXd::Zero(q.size())), maps.stiffness()) < 1e-14);
  CHECK(relative_error(found, maps.stiffness()) > 1e-3);
}

}  // namespace

TEST_CASE("an element's tangent is the derivative of its force") {
  check_tangent(fem::planar_beam({0, 0}, {1.1, 0.4}, {50, 0.7, 3, 0.2}, fem::MembraneStrain::averaged), 0.3);
  check_tangent(fem::shell_triangle({Vector3d(0.2, -0.1, 0), Vector3d(1.3, 0.2, 0.1), Vector3d(0.5, 0.9, 0)},
                                    testing::skew_laminate()),
                0.3);
  check_tangent(fem::planar_beam({0, 0}, {1.1, 0.4}, {50, 0.7, 3, 0.2}, fem::MembraneStrain::pointwise), 0.3);
  check_tangent(fem::shell_quadrilateral(
                    {Vector3d(0.2, -0.1, 0), Vector3d(1.3, 0.2, 0), Vector3d(1.2, 1.1, 0), Vector3d(0.3, 0.9, 0)},
                    testing::skew_laminate()),
                0.3);
}

TEST_CASE("the tangent of shells with strains of second order, free and at rigid regions") {
  fem::ShellSection section = testing::skew_laminate();
  section.strains = fem::Strains::second_order;
  const fem::TriangleNodes triangle{Vector3d(0.2, -0.1, 0), Vector3d(1.3, 0.2, 0.1), Vector3d(0.5, 0.9, 0)};
  check_tangent(fem::shell_triangle(triangle, section), 0.3);
  check_tangent(
      fem::shell_quadrilateral(
          {Vector3d(0.2, -0.1, 0), Vector3d(1.3, 0.2, 0), Vector3d(1.2, 1.1, 0), Vector3d(0.3, 0.9, 0)}, section),
      0.3);
  check_tangent(
      fem::shell_quadrilateral(
          {Vector3d(0.2, -0.1, 0), Vector3d(1.3, 0.2, 0.2), Vector3d(1.2, 1.1, -0.1), Vector3d(0.3, 0.9, 0)}, section),
      0.3);
  fem::ElementMaps maps = fem::shell_triangle(triangle, section);  // its second and third node follow the first
  const Vector3d arms[] = {triangle[1] - triangle[0], {0.3, -0.2, 0.5}};
  MatrixXd T = MatrixXd::Identity(18, 18);
  for (int i = 1; i < 3; ++i) {
    T.block<6, 6>(6 * i, 6 * i).setZero();
    T.block<6, 6>(6 * i, 0) = fem::rigid_arm(arms[i - 1]);
  }
  check_tangent(fem::transformed(maps, T.leftCols(6), {{6, 3, arms[0]}, {12, 3, arms[1]}}), 0.3);
}
