#include "floe/fem/joint_frame.h"

#include <catch2/catch.hpp>

#include "differences.h"
#include "random.h"
#include "structures.h"

using namespace floe;
using Eigen::VectorXd;
using testing::everywhere;
using testing::Random;
using Kind = fem::ReferenceFrame::Kind;

namespace {

VectorXd projected(const fem::Structure& s, const fem::ReferenceFrame& frame, const VectorXd& q) {
  const petsc::VecHandle field = testing::field_of(s, q);
  fem::to_frame(frame, field);
  return everywhere(field);
}

}  // namespace

TEST_CASE("what joints see of a displacement is the same in every frame, and vanishes for rigid motions") {
  const Kind kind = GENERATE(Kind::pinned, Kind::clamped, Kind::mean_axis);
  // free, hinged at the end, clamped at the middle, hinged at both ends (more than rigid motions), slide along x
  const fem::Conditions constrained = GENERATE(fem::Conditions{}, fem::Conditions{18, 19}, fem::Conditions{9, 10, 11},
                                               fem::Conditions{0, 1, 18, 19}, fem::Conditions{1, 2});
  const fem::Structure s = testing::straight(PETSC_COMM_WORLD, 6, 3, {50, 0.7, 3, 0.2});
  const fem::ReferenceFrame frame = fem::reference_frame(s, kind, 0, 6);
  const fem::ReferenceFrame joints = fem::joint_frame(s, frame, constrained);
  const VectorXd q = Random(41).vector(s.dofs());
  const VectorXd Pq = projected(s, joints, q);
  CHECK(testing::relative_error(projected(s, joints, projected(s, frame, q)), Pq) < 1e-12);
  CHECK(testing::relative_error(projected(s, joints, Pq), Pq) < 1e-12);
  for (const auto& motion : frame.rigid) CHECK(projected(s, joints, everywhere(motion)).cwiseAbs().maxCoeff() < 1e-12);
  // a displacement that is zero where joints hold, without the rigid motions that they leave, is its own vibration
  VectorXd own = q;
  for (PetscInt dof : constrained) own[dof] = 0;
  const fem::Holding holding = fem::holding(s, frame, constrained);
  const petsc::MatHandle M = fem::mass(s, {});
  Eigen::MatrixXd left(s.dofs(), holding.left.cols());
  for (Eigen::Index j = 0; j < left.cols(); ++j) {
    left.col(j).setZero();
    for (int i = 0; i < 3; ++i) left.col(j) += holding.left(i, j) * everywhere(frame.rigid[i]);
  }
  if (left.cols() > 0) {
    Eigen::MatrixXd M_left(s.dofs(), left.cols());
    for (Eigen::Index j = 0; j < left.cols(); ++j)
      M_left.col(j) = testing::product(M, testing::field_of(s, left.col(j)));
    own -= left * (left.transpose() * M_left).ldlt().solve(M_left.transpose() * own);
  }
  CHECK(testing::relative_error(projected(s, joints, own), own) < 1e-12);
  // V'P'MPV of that one and of a rigid motion
  std::vector<petsc::VecHandle> V;
  V.push_back(testing::field_of(s, own));
  V.push_back(testing::field_of(s, everywhere(frame.rigid[2])));
  const Eigen::MatrixXd seen = fem::mass_seen(s, joints, V);
  CHECK(seen(0, 0) == Approx(own.dot(testing::product(M, V[0]))).epsilon(1e-12));
  CHECK(std::abs(seen(0, 1)) + std::abs(seen(1, 1)) < 1e-10 * seen(0, 0));
}
