#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "differences.h"
#include "spatial_structures.h"

using namespace floe;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;
using testing::Random;
using testing::Spread;

namespace {

/// Mass, its first moment and int rho x x' of the mixed structure, by hand.
struct Mass {
  double m = 0;
  Vector3d s = Vector3d::Zero();
  Matrix3d C = Matrix3d::Zero();
  void add(double mass, const Vector3d& centre, const Matrix3d& about) {
    m += mass, s += mass * centre, C += mass * (centre * centre.transpose()) + about;
  }
};

/// A parallelogram of mass `rho` per area with its middle, int rho x x' = m (a a' + b b' + h^2 n n') / 12 about it.
void add_plate(Mass& sum, const Vector3d& middle, const Vector3d& a, const Vector3d& b, double density, double h) {
  const Vector3d n = a.cross(b).normalized();
  const double m = density * h * a.cross(b).norm();
  sum.add(m, middle, m / 12 * (a * a.transpose() + b * b.transpose() + h * h * n * n.transpose()));
}

Mass mixed_mass() {
  Mass sum;
  const Vector3d y(0, 1, 0), ramp(0.8, 0, 0.6), n(-0.6, 0, 0.8);
  add_plate(sum, {0.5, 0.5, 0}, {1, 0, 0}, y, 4, 0.1);
  add_plate(sum, Vector3d(1, 0.5, 0) + 0.5 * ramp + 0.02 * n, ramp, y, 2, 0.1);  // its middle lies 0.02 above the nodes
  const Vector3d mast(0, -0.5, 0.8), x = mast.normalized();
  const Vector3d ey = Vector3d(1, 0, 0), ez = x.cross(ey);  // (1, 0, 0) is at a right angle to the mast
  const double m = 3 * mast.norm(), L = mast.norm();
  const Matrix3d section = 0.03 * ey * ey.transpose() + 0.02 * ez * ez.transpose() +
                           0.005 * (ey * ez.transpose() + ez * ey.transpose());  // int y^2 = Iz
  sum.add(m, Vector3d(1.8, 0, 0.6) + 0.5 * mast + 0.02 * ey - 0.01 * ez,
          m / 12 * mast * mast.transpose() + L * section);
  const Matrix3d J = Vector3d(0.03, 0.04, 0.05).asDiagonal();
  sum.add(0.7, Vector3d(1.8, -0.5, 1.4) + Vector3d(0.1, 0, 0.2), 0.5 * J.trace() * Matrix3d::Identity() - J);
  return sum;
}

/// Sum over the cells of an element matrix from its maps, times x, by original dofs.
VectorXd element_product(const fem::Structure& s, Eigen::MatrixXd (fem::ElementMaps::*matrix)() const,
                         const VectorXd& x) {
  VectorXd y = VectorXd::Zero(s.dofs());
  for (const auto& cell : s.mesh.cells) {
    std::vector<PetscInt> dofs;
    for (int local : s.cell_dofs(cell)) dofs.push_back(s.original_dof(local));
    y(dofs) += (s.maps(cell).*matrix)() * x(dofs);
  }
  MPI_Allreduce(MPI_IN_PLACE, y.data(), static_cast<int>(y.size()), MPI_DOUBLE, MPI_SUM, s.mesh.comm);
  return y;
}

}  // namespace

TEST_CASE("K and M of a mixed mesh are the sums over its elements, on any partition") {
  const Spread spread = GENERATE(Spread::metis, Spread::shuffled, Spread::last);
  const auto order = GENERATE(testing::Order::first, testing::Order::second);
  const auto strains = fem::Strains::von_karman;
  const fem::Structure s = testing::mixed_structure(PETSC_COMM_WORLD, spread, strains, order),
                       alone = testing::mixed_structure(PETSC_COMM_SELF, Spread::last, strains, order);
  if (order == testing::Order::first) REQUIRE(s.dofs() == 6 * 21);
  const petsc::MatHandle K = fem::stiffness(s, {}), M = fem::mass(s, {});
  for (unsigned seed : {51u, 52u, 53u}) {
    const VectorXd x = Random(seed).vector(s.dofs());
    const VectorXd Kx = testing::product_in_originals(s, K, x), Mx = testing::product_in_originals(s, M, x);
    CHECK(testing::relative_error(Kx, element_product(alone, &fem::ElementMaps::stiffness, x)) < 1e-13);
    CHECK(testing::relative_error(Mx, element_product(alone, &fem::ElementMaps::mass_matrix, x)) < 1e-13);
    CHECK((x.dot(Kx) > 0 && x.dot(Mx) > 0));
  }
}

TEST_CASE(
    "conditions in space empty their rows and columns; the stiffness keeps a positive diagonal there, the mass none") {
  const fem::Structure s = testing::mixed_structure(PETSC_COMM_WORLD, Spread::shuffled);
  const std::vector<PetscInt> nodes{0, 11, 20};
  const std::vector<int> directions{0, 4, 5};
  const fem::Conditions constrained = testing::dofs_of(s, nodes, directions);
  VectorXd x = Random(54).vector(s.dofs()), without = x;
  for (PetscInt node : nodes)
    for (int d : directions) without[6 * node + d] = 0;
  const auto check = [&](Mat conditioned, Mat plain, bool diagonal) {
    VectorXd expected = testing::product_in_originals(s, plain, without);
    const VectorXd found = testing::product_in_originals(s, conditioned, x);
    for (PetscInt node : nodes)
      for (int d : directions) {
        const double ratio = found[6 * node + d] / x[6 * node + d];
        CHECK((diagonal ? ratio > 0 : ratio == 0));
        expected[6 * node + d] = found[6 * node + d];
      }
    CHECK(testing::relative_error(found, expected) < 1e-13);
  };
  check(fem::stiffness(s, constrained), fem::stiffness(s, {}), true);
  check(fem::mass(s, constrained), fem::mass(s, {}), false);
}

TEST_CASE("six rigid motions bring no force and carry mass, first and second moments") {
  const fem::Structure s = testing::mixed_structure(PETSC_COMM_WORLD, Spread::metis);
  const auto rigid = fem::rigid_motions(s);
  REQUIRE(rigid.size() == 6);
  const petsc::MatHandle K = fem::stiffness(s, {}), M = fem::mass(s, {});
  const Mass mass = mixed_mass();
  Eigen::Matrix<double, 6, 6> expected;
  Matrix3d across;  // u_r = e_r x s for the rotation r
  for (int r = 0; r < 3; ++r) across.col(r) = Vector3d::Unit(r).cross(mass.s);
  expected << mass.m * Matrix3d::Identity(), across, across.transpose(), mass.C.trace() * Matrix3d::Identity() - mass.C;
  for (int i = 0; i < 6; ++i) {
    CHECK(testing::product(K, rigid[i]).cwiseAbs().maxCoeff() < 1e-12 * 500);
    for (int j = 0; j < 6; ++j)
      CHECK(testing::form(M, rigid[i], rigid[j]) == Approx(expected(i, j)).epsilon(1e-12).margin(1e-13));
  }
}

TEST_CASE("stiffness derivatives of a mixed mesh: the same on any partition, symmetric, one by one or many") {
  const Spread spread = GENERATE(Spread::metis, Spread::shuffled);
  const auto order = GENERATE(testing::Order::first, testing::Order::second);
  const auto strains = GENERATE(fem::Strains::von_karman, fem::Strains::second_order);
  const fem::Structure s = testing::mixed_structure(PETSC_COMM_WORLD, spread, strains, order),
                       alone = testing::mixed_structure(PETSC_COMM_SELF, Spread::last, strains, order);
  const VectorXd a = Random(55).vector(s.dofs()), b = Random(56).vector(s.dofs());
  const auto derivative = [](const fem::Structure& of, const VectorXd& x, const VectorXd& y) {
    return testing::in_original_order(
        of, fem::stiffness_derivative(of, testing::field_of_originals(of, x), testing::field_of_originals(of, y)));
  };
  const VectorXd expected = derivative(alone, a, b);
  CHECK(expected.norm() > 1);
  CHECK(testing::relative_error(derivative(s, a, b), expected) < 1e-12);
  CHECK(testing::relative_error(derivative(s, b, a), expected) < 1e-12);
  std::vector<petsc::VecHandle> fields;
  fields.push_back(testing::field_of_originals(s, a)), fields.push_back(testing::field_of_originals(s, b));
  const auto many = fem::stiffness_derivatives(s, fields, {{1, 1}, {0, 1}});
  REQUIRE(many.size() == 2);
  CHECK(testing::relative_error(testing::in_original_order(s, many[1]), expected) < 1e-12);
  CHECK(testing::relative_error(testing::in_original_order(s, many[0]), derivative(alone, b, b)) < 1e-12);
}

TEST_CASE("a stiffness derivative is the derivative of the linear force along a field") {
  // dK/deta_j phi_i at q = 0 from the energy: second differences of grad U, which is a cubic
  const fem::Structure s = testing::mixed_structure(PETSC_COMM_WORLD, Spread::metis);
  const VectorXd a = Random(57).vector(s.dofs()), b = Random(58).vector(s.dofs());
  const auto force = [&](double x, double y) {
    VectorXd f = VectorXd::Zero(s.dofs());
    body::ElasticityWork work;
    for (const auto& cell : s.mesh.cells) {
      std::vector<PetscInt> dofs;
      for (int local : s.cell_dofs(cell)) dofs.push_back(s.original_dof(local));
      const auto n = static_cast<Eigen::Index>(dofs.size());
      const body::Elasticity e = fem::elasticity(s.maps(cell), Eigen::MatrixXd::Identity(n, n));
      VectorXd own = VectorXd::Zero(n);
      body::add_force(e, x * a(dofs) + y * b(dofs), work, own);
      f(dofs) += own;
    }
    MPI_Allreduce(MPI_IN_PLACE, f.data(), static_cast<int>(f.size()), MPI_DOUBLE, MPI_SUM, s.mesh.comm);
    return f;
  };
  const VectorXd mixed = (force(1, 1) - force(1, -1) - force(-1, 1) + force(-1, -1)) / 4;  // exact for cubics
  const auto found = testing::in_original_order(
      s, fem::stiffness_derivative(s, testing::field_of_originals(s, a), testing::field_of_originals(s, b)));
  CHECK(testing::relative_error(found, mixed) < 1e-11);
}
