#include "floe/fem/element_stiffness.h"

#include <catch2/catch.hpp>

#include "differences.h"
#include "random.h"
#include "structures.h"

using namespace floe;
using Eigen::MatrixXd;
using Eigen::VectorXd;

TEST_CASE("the operator by elements is the assembled matrix, conditions and all") {
  const fem::Conditions constrained = GENERATE(fem::Conditions{}, fem::Conditions{0, 1, 2, 22});
  const fem::Mesh mesh = fem::mesh_of(PETSC_COMM_WORLD, testing::l_shape(2, 1, 4));
  const fem::Structure s = fem::planar_structure(mesh, {{50, 1, 1, 0}, {70, 2, 1, 0}}, fem::MembraneStrain::averaged);
  const auto elements = std::make_shared<fem::ElementStiffness>(s);
  const petsc::MatHandle exact = fem::stiffness_operator(elements, constrained),
                         assembled = fem::stiffness(s, constrained);
  const VectorXd q = testing::Random(81).vector(s.dofs());
  const petsc::VecHandle x = testing::field_of(s, q);
  const VectorXd expected = testing::product(assembled, x);
  CHECK(testing::relative_error(testing::product(exact, x), expected) < 1e-13);
  if (constrained.empty()) CHECK(elements->strain_energy(x) == Approx(q.dot(expected) / 2).epsilon(1e-12));
}

TEST_CASE("a rigid motion on a fine mesh has no strain energy: an assembled matrix would give eps n^3") {
  const PetscInt n = 20000;
  const fem::Structure s = testing::straight(PETSC_COMM_WORLD, n, 1, {1e4, 1, 1, 0});
  const fem::ElementStiffness elements(s);
  for (const auto& motion : fem::rigid_motions(s)) CHECK(elements.strain_energy(motion) < 1e-12);
}

TEST_CASE("a small rigid motion of an element in space is taken off, a strain stays") {
  const Eigen::Vector3d move(0.3, -2, 5), rotation(0.7, -0.4, 0.9);
  Eigen::Matrix3Xd arms(3, 2);
  arms << 0, 0.5, 0, -0.25, 0, 2;
  MatrixXd q(12, 1);
  for (int i = 0; i < 2; ++i) {
    const Eigen::Vector3d arm = arms.col(i);
    q.block<3, 1>(6 * i, 0) = move + rotation.cross(arm);
    q.block<3, 1>(6 * i + 3, 0) = rotation;
  }
  const VectorXd strain = VectorXd::LinSpaced(6, 1, 6);
  q.bottomRows(6) += strain;
  fem::take_rigid_motion(q, arms);
  CHECK(q.topRows(6).norm() == 0);
  CHECK((q.bottomRows(6) - strain).norm() < 1e-14);
}
