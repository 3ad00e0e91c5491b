#include "floe/fem/structure.h"

#include <catch2/catch.hpp>

#include "differences.h"
#include "random.h"
#include "structures.h"

using namespace floe;
using Eigen::VectorXd;
using testing::everywhere;
using testing::Random;

namespace {

/// Two members of different sections at a right angle.
fem::Structure angle(MPI_Comm comm) {
  return fem::planar_structure(fem::mesh_of(comm, testing::l_shape(2, 1, 3)), {{50, 0.7, 3, 0.2}, {20, 0.5, 2, 0}},
                               fem::MembraneStrain::averaged);
}

/// Dense sum over the cells, by global dofs.
Eigen::MatrixXd dense(const fem::Structure& s, Eigen::MatrixXd (fem::ElementMaps::*matrix)() const) {
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(s.dofs(), s.dofs());
  for (const auto& cell : s.mesh.cells) {
    std::vector<PetscInt> dofs;
    for (int local : s.cell_dofs(cell)) dofs.push_back(s.global_dof(local));
    sum(dofs, dofs) += (s.maps(cell).*matrix)();
  }
  return sum;
}

Eigen::MatrixXd columns(const fem::Structure& s, Mat A) {
  Eigen::MatrixXd all(s.dofs(), s.dofs());
  for (Eigen::Index j = 0; j < all.cols(); ++j)
    all.col(j) = testing::product(A, testing::field_of(s, VectorXd::Unit(all.rows(), j)));
  return all;
}

}  // namespace

TEST_CASE("assembled K and M are the sums over the elements, on any number of ranks") {
  const fem::Structure s = angle(PETSC_COMM_WORLD), alone = angle(PETSC_COMM_SELF);
  CHECK(testing::relative_error(columns(s, fem::stiffness(s, {})), dense(alone, &fem::ElementMaps::stiffness)) < 1e-14);
  CHECK(testing::relative_error(columns(s, fem::mass(s, {})), dense(alone, &fem::ElementMaps::mass_matrix)) < 1e-14);
}

TEST_CASE("conditions empty their rows and columns; the stiffness keeps a positive diagonal there, the mass none") {
  const fem::Structure s = angle(PETSC_COMM_WORLD), alone = angle(PETSC_COMM_SELF);
  const fem::Conditions constrained{0, 1, 11, 20};
  Eigen::MatrixXd K = dense(alone, &fem::ElementMaps::stiffness), M = dense(alone, &fem::ElementMaps::mass_matrix);
  for (PetscInt dof : constrained)
    for (auto* A : {&K, &M}) A->row(dof).setZero(), A->col(dof).setZero();
  Eigen::MatrixXd found = columns(s, fem::stiffness(s, constrained));
  for (PetscInt dof : constrained) {
    CHECK(found(dof, dof) > 0);
    found(dof, dof) = 0;
  }
  CHECK(testing::relative_error(found, K) < 1e-14);
  CHECK(testing::relative_error(columns(s, fem::mass(s, constrained)), M) < 1e-14);
}

TEST_CASE("rigid motions of a structure bring no force and carry its mass") {
  const fem::Structure s = angle(PETSC_COMM_WORLD);
  const auto rigid = fem::rigid_motions(s);
  const petsc::MatHandle K = fem::stiffness(s, {}), M = fem::mass(s, {});
  for (const auto& motion : rigid) CHECK(testing::product(K, motion).cwiseAbs().maxCoeff() < 1e-12 * 50);
  CHECK(testing::form(M, rigid[0], rigid[0]) == Approx(3 * 2 + 2 * 1).epsilon(1e-13));
  CHECK(std::abs(testing::form(M, rigid[0], rigid[1])) < 1e-13);
  // about the origin: 3 (2^3/3) + 0.2 * 2 of the first member, 2 (2^2 + 1/3) of the second
  CHECK(testing::form(M, rigid[2], rigid[2]) == Approx(8 + 0.4 + 2 * (4 + 1. / 3)).epsilon(1e-13));
  // first moment: 3 * 2 * 1 + 2 * 2
  CHECK(testing::form(M, rigid[1], rigid[2]) == Approx(10).epsilon(1e-13));
}

TEST_CASE("exchange: gather hands out copies of foreign values, add sums what all ranks bring") {
  const fem::Structure s = angle(PETSC_COMM_WORLD);
  const VectorXd values = Random(31).vector(s.dofs());
  const VectorXd local = s.exchange.gather(testing::field_of(s, values));
  REQUIRE(local.size() == static_cast<Eigen::Index>(3 * s.mesh.positions.size()));
  for (int i = 0; i < local.size(); ++i) CHECK(local[i] == values[s.global_dof(i)]);
  const petsc::VecHandle sum = fem::field(s);
  s.exchange.add(VectorXd::Ones(local.size()), sum);
  std::vector<double> seen(static_cast<std::size_t>(s.dofs()), 0.0);
  for (int i = 0; i < local.size(); ++i) seen[s.global_dof(i)] += 1;
  MPI_Allreduce(MPI_IN_PLACE, seen.data(), static_cast<int>(seen.size()), MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
  CHECK(everywhere(sum) == Eigen::Map<VectorXd>(seen.data(), s.dofs()));
}

TEST_CASE("stiffness derivative: the same on any number of ranks, symmetric") {
  const fem::Structure s = angle(PETSC_COMM_WORLD), alone = angle(PETSC_COMM_SELF);
  const VectorXd a = Random(32).vector(s.dofs()), b = Random(33).vector(s.dofs());
  const auto derivative = [](const fem::Structure& of, const VectorXd& x, const VectorXd& y) {
    return everywhere(fem::stiffness_derivative(of, testing::field_of(of, x), testing::field_of(of, y)));
  };
  const VectorXd expected = derivative(alone, a, b);
  CHECK(expected.norm() > 1);
  CHECK(testing::relative_error(derivative(s, a, b), expected) < 1e-13);
  CHECK(testing::relative_error(derivative(s, b, a), expected) < 1e-13);
}

TEST_CASE("hold sets the entries of conditions to zero and no others") {
  const fem::Structure s = angle(PETSC_COMM_WORLD);
  VectorXd values = VectorXd::Ones(s.dofs());
  const petsc::VecHandle field = testing::field_of(s, values);
  fem::hold(field, {0, 7, 20});
  values[0] = values[7] = values[20] = 0;
  CHECK(everywhere(field) == values);
}
