#include "floe/fem/reference_frame.h"

#include <algorithm>

namespace floe::fem {

using petsc::check;

namespace {

petsc::VecHandle unit(const Structure& structure, PetscInt dof) {
  petsc::VecHandle e = field(structure);
  PetscInt first = 0, end = 0;
  check(VecGetOwnershipRange(e, &first, &end));
  if (dof >= first && dof < end) check(VecSetValue(e, dof, 1, INSERT_VALUES));
  check(VecAssemblyBegin(e));
  check(VecAssemblyEnd(e));
  return e;
}

/// A length of the body, to compare rotations with displacements.
double extent(const Structure& structure) {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(1e300), high = -low;
  for (const Eigen::Vector3d& x : structure.mesh.positions) low = low.cwiseMin(x), high = high.cwiseMax(x);
  MPI_Allreduce(MPI_IN_PLACE, low.data(), 3, MPI_DOUBLE, MPI_MIN, structure.mesh.comm);
  MPI_Allreduce(MPI_IN_PLACE, high.data(), 3, MPI_DOUBLE, MPI_MAX, structure.mesh.comm);
  return (high - low).norm();
}

/// Entries of the rigid motions at some dofs, (dofs x 3), rotations scaled by 1 / extent. Collective.
Eigen::MatrixX3d rigid_rows(const ReferenceFrame& frame, const Conditions& dofs, double length) {
  Eigen::MatrixX3d rows = Eigen::MatrixX3d::Zero(static_cast<Eigen::Index>(dofs.size()), 3);
  MPI_Comm comm = PetscObjectComm(reinterpret_cast<PetscObject>(frame.rigid[0].get()));
  for (int motion = 0; motion < 3; ++motion) {
    PetscInt first = 0, end = 0;
    const double* values = nullptr;
    check(VecGetOwnershipRange(frame.rigid[motion], &first, &end));
    check(VecGetArrayRead(frame.rigid[motion], &values));
    for (std::size_t i = 0; i < dofs.size(); ++i)
      if (dofs[i] >= first && dofs[i] < end)
        rows(i, motion) = values[dofs[i] - first] * (dofs[i] % Structure::dofs_per_node == 2 ? length : 1);
    check(VecRestoreArrayRead(frame.rigid[motion], &values));
  }
  rows.col(2) /= length;
  MPI_Allreduce(MPI_IN_PLACE, rows.data(), static_cast<int>(rows.size()), MPI_DOUBLE, MPI_SUM, comm);
  return rows;
}

int rank_of(const Eigen::MatrixX3d& rows) {
  if (rows.rows() == 0) return 0;
  Eigen::JacobiSVD<Eigen::MatrixXd> svd(rows);
  return static_cast<int>((svd.singularValues().array() > 1e-9).count());
}

}  // namespace

ReferenceFrame reference_frame(const Structure& structure, ReferenceFrame::Kind kind, PetscInt a, PetscInt b) {
  ReferenceFrame frame;
  frame.kind = kind;
  frame.rigid = rigid_motions(structure);
  if (kind == ReferenceFrame::Kind::mean_axis) {
    const petsc::MatHandle M = mass(structure, {});
    for (const auto& motion : frame.rigid) {
      frame.functionals.push_back(field(structure));
      check(MatMult(M, motion, frame.functionals.back()));
    }
  } else {
    frame.conditions = {3 * a, 3 * a + 1, kind == ReferenceFrame::Kind::pinned ? 3 * b + 1 : 3 * a + 2};
    for (PetscInt dof : frame.conditions) frame.functionals.push_back(unit(structure, dof));
    std::sort(frame.conditions.begin(), frame.conditions.end());
  }
  Eigen::Matrix3d values;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) check(VecDot(frame.functionals[i], frame.rigid[j], &values(i, j)));
  const Eigen::FullPivLU<Eigen::Matrix3d> lu(values);
  if (!lu.isInvertible()) throw InputError("the reference conditions leave a rigid motion of the body free");
  frame.inverse = lu.inverse();
  return frame;
}

void to_frame(const ReferenceFrame& frame, Vec q) {
  Eigen::Vector3d c;
  for (int i = 0; i < 3; ++i) check(VecDot(frame.functionals[i], q, &c[i]));
  c = -frame.inverse * c;
  for (int i = 0; i < 3; ++i) check(VecAXPY(q, c[i], frame.rigid[i]));
  hold(q, frame.conditions);
}

void balance(const ReferenceFrame& frame, Vec f) {
  Eigen::Vector3d c;
  for (int i = 0; i < 3; ++i) check(VecDot(frame.rigid[i], f, &c[i]));
  c = -frame.inverse.transpose() * c;
  for (int i = 0; i < 3; ++i) check(VecAXPY(f, c[i], frame.functionals[i]));
}

Holding holding(const Structure& structure, const ReferenceFrame& frame, Conditions held) {
  const double length = extent(structure);
  Holding result;
  result.held = held;
  const Eigen::MatrixX3d rows = rigid_rows(frame, held, length);
  if (held.empty()) {
    result.left = Eigen::Matrix3d::Identity();
  } else {
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(rows, Eigen::ComputeFullV);
    const int rank = static_cast<int>((svd.singularValues().array() > 1e-9).count());
    result.left = svd.matrixV().rightCols(3 - rank);
    result.left.row(2) /= length;
  }
  // Frame conditions, then plain ones at the first node, until K is regular.
  Conditions candidates = frame.conditions;
  candidates.insert(candidates.end(), {0, 1, 2});
  result.statics = std::move(held);
  for (PetscInt dof : candidates) {
    Conditions more = result.statics;
    more.push_back(dof);
    if (rank_of(rigid_rows(frame, more, length)) > rank_of(rigid_rows(frame, result.statics, length)))
      result.statics = std::move(more);
  }
  std::sort(result.statics.begin(), result.statics.end());
  return result;
}

}  // namespace floe::fem
