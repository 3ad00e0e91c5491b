#include "floe/fem/reference_frame.h"

#include <algorithm>

#include "floe/fem/constrained_frame.h"
#include "floe/fem/joint_frame.h"

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

/// Entries of the rigid motions at some dofs, (dofs x motions), rotations scaled by 1 / extent. Collective.
Eigen::MatrixXd rigid_rows(const Structure& structure, const std::vector<petsc::VecHandle>& rigid,
                           const Conditions& dofs, double length) {
  const int motions = structure.rigid_motion_count(), d = structure.dimension();
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(dofs.size()), motions);
  for (int motion = 0; motion < motions; ++motion) {
    PetscInt first = 0, end = 0;
    const double* values = nullptr;
    check(VecGetOwnershipRange(rigid[motion], &first, &end));
    check(VecGetArrayRead(rigid[motion], &values));
    for (std::size_t i = 0; i < dofs.size(); ++i)
      if (dofs[i] >= first && dofs[i] < end)
        rows(i, motion) = values[dofs[i] - first] * (dofs[i] % structure.dofs_per_node >= d ? length : 1);
    check(VecRestoreArrayRead(rigid[motion], &values));
  }
  rows.rightCols(motions - d) /= length;
  MPI_Allreduce(MPI_IN_PLACE, rows.data(), static_cast<int>(rows.size()), MPI_DOUBLE, MPI_SUM, structure.mesh.comm);
  return rows;
}

int rank_of(const Eigen::MatrixXd& rows) {
  if (rows.rows() == 0) return 0;
  Eigen::JacobiSVD<Eigen::MatrixXd> svd(rows);
  return static_cast<int>((svd.singularValues().array() > 1e-9).count());
}

/// (f' Phi_r)^-1 of the frame's functionals. @throws InputError  they leave a rigid motion free
void set_inverse(const Structure& structure, ReferenceFrame& frame) {
  const int r = structure.rigid_motion_count();
  Eigen::MatrixXd values(r, r);
  for (int i = 0; i < r; ++i)
    for (int j = 0; j < r; ++j) check(VecDot(frame.functionals[i], frame.rigid[j], &values(i, j)));
  // lengths and angles stand beside one another: judged without their units
  const auto scale_of = [](const auto& line) {
    return line.cwiseAbs().maxCoeff() > 0 ? 1 / line.cwiseAbs().maxCoeff() : 1;
  };
  Eigen::VectorXd rows(r), columns(r);
  for (int j = 0; j < r; ++j) columns[j] = scale_of(values.col(j));
  const Eigen::MatrixXd by_columns = values * columns.asDiagonal();
  for (int i = 0; i < r; ++i) rows[i] = scale_of(by_columns.row(i));
  const Eigen::FullPivLU<Eigen::MatrixXd> lu(rows.asDiagonal() * by_columns);
  if (!lu.isInvertible()) throw InputError("the frame's conditions leave a rigid motion of the body free");
  frame.inverse = columns.asDiagonal() * lu.inverse() * rows.asDiagonal();
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
    const PetscInt n = structure.dofs_per_node;
    for (PetscInt i = 0; i < n; ++i) frame.conditions.push_back(n * a + i);
    if (kind == ReferenceFrame::Kind::pinned) {
      frame.conditions.resize(n == 3 ? 2 : 4);
      for (PetscInt i = 1; i < structure.dimension(); ++i) frame.conditions.push_back(n * b + i);
    }
    for (PetscInt dof : frame.conditions) frame.functionals.push_back(unit(structure, dof));
    std::sort(frame.conditions.begin(), frame.conditions.end());
  }
  set_inverse(structure, frame);
  return frame;
}

ReferenceFrame constrained_frame(const Structure& structure, const Conditions& dofs) {
  ReferenceFrame frame;
  frame.kind = ReferenceFrame::Kind::clamped;
  frame.rigid = rigid_motions(structure);
  constexpr double last = 1e-3;  // rotations of pins and about normals of shells are soft: displacements come first
  Eigen::MatrixXd rows = rigid_rows(structure, frame.rigid, dofs, extent(structure));
  for (std::size_t i = 0; i < dofs.size(); ++i)
    if (dofs[i] % structure.dofs_per_node >= structure.dimension()) rows.row(static_cast<Eigen::Index>(i)) *= last;
  if (rank_of(rows) < rows.cols()) throw InputError("the frame's conditions leave a rigid motion of the body free");
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> most_independent(rows.transpose());
  for (Eigen::Index i = 0; i < rows.cols(); ++i)
    frame.conditions.push_back(dofs[most_independent.colsPermutation().indices()[i]]);
  std::sort(frame.conditions.begin(), frame.conditions.end());
  for (PetscInt dof : frame.conditions) frame.functionals.push_back(unit(structure, dof));
  set_inverse(structure, frame);
  return frame;
}

bool determine_rigid_motions(const Structure& structure, const Conditions& dofs) {
  return rank_of(rigid_rows(structure, rigid_motions(structure), dofs, extent(structure))) ==
         structure.rigid_motion_count();
}

namespace {

/// field += sum_i weights_i directions_i
void add(Vec field, const Eigen::VectorXd& weights, const std::vector<petsc::VecHandle>& directions) {
  const std::vector<Vec> plain(directions.begin(), directions.end());
  check(VecMAXPY(field, static_cast<PetscInt>(plain.size()), weights.data(), const_cast<Vec*>(plain.data())));
}

Eigen::VectorXd dots(Vec field, const std::vector<petsc::VecHandle>& directions) {
  const std::vector<Vec> plain(directions.begin(), directions.end());
  Eigen::VectorXd values(static_cast<Eigen::Index>(plain.size()));
  check(VecMDot(field, static_cast<PetscInt>(plain.size()), plain.data(), values.data()));
  return values;
}

}  // namespace

void to_frame(const ReferenceFrame& frame, Vec q) {
  add(q, -frame.inverse * dots(q, frame.functionals), frame.rigid);
  hold(q, frame.conditions);
}

void balance(const ReferenceFrame& frame, Vec f) {
  add(f, -frame.inverse.transpose() * dots(f, frame.rigid), frame.functionals);
}

namespace {

/// Global number of the first node that follows no other one. Collective.
PetscInt first_free_node(const Mesh& mesh) {
  int local = 0;
  for (const Mesh::DependentNode& f : mesh.dependent_nodes)
    if (f.node == local) ++local;
  PetscInt first = local < mesh.owned_nodes ? mesh.first_node + local : PETSC_MAX_INT;
  MPI_Allreduce(MPI_IN_PLACE, &first, 1, MPIU_INT, MPI_MIN, mesh.comm);
  return first;
}

}  // namespace

Holding holding(const Structure& structure, const ReferenceFrame& frame, Conditions constrained) {
  const Conditions dependent_nodes = dependent_dofs(structure.mesh, structure.dofs_per_node);
  constrained.insert(constrained.end(), dependent_nodes.begin(), dependent_nodes.end());
  std::sort(constrained.begin(), constrained.end());
  constrained.erase(std::unique(constrained.begin(), constrained.end()), constrained.end());
  const double length = extent(structure);
  Holding result;
  result.constrained = constrained;
  const int d = structure.dimension(), motions = structure.rigid_motion_count();
  const Eigen::MatrixXd rows = rigid_rows(structure, frame.rigid, constrained, length);
  if (constrained.empty()) {
    result.left = Eigen::MatrixXd::Identity(motions, motions);
  } else {
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(rows, Eigen::ComputeFullV);
    const int rank = static_cast<int>((svd.singularValues().array() > 1e-9).count());
    result.left = svd.matrixV().rightCols(motions - rank);
    result.left.bottomRows(motions - d) /= length;
  }
  // Frame conditions, then plain ones at the first node that follows none, until K is regular.
  Conditions candidates = frame.conditions;
  const PetscInt n = structure.dofs_per_node, first = n * first_free_node(structure.mesh);
  for (PetscInt dof = first; dof < first + n; ++dof) candidates.push_back(dof);
  result.statics = std::move(constrained);
  for (PetscInt dof : candidates) {
    Conditions more = result.statics;
    more.push_back(dof);
    if (rank_of(rigid_rows(structure, frame.rigid, more, length)) >
        rank_of(rigid_rows(structure, frame.rigid, result.statics, length)))
      result.statics = std::move(more);
  }
  std::sort(result.statics.begin(), result.statics.end());
  return result;
}

ReferenceFrame joint_frame(const Structure& structure, const ReferenceFrame& frame, const Conditions& constrained) {
  const int motions = structure.rigid_motion_count(), d = structure.dimension();
  const PetscInt n = structure.dofs_per_node;
  const double length = extent(structure);
  const Eigen::MatrixXd rows =
      rigid_rows(structure, frame.rigid, constrained, length);  // of motions with rotations times length
  Eigen::MatrixXd seen(motions, 0), free = Eigen::MatrixXd::Identity(motions, motions);
  if (!constrained.empty()) {
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(rows, Eigen::ComputeFullV);
    const int rank = static_cast<int>((svd.singularValues().array() > 1e-9).count());
    seen = svd.matrixV().leftCols(rank), free = svd.matrixV().rightCols(motions - rank);
  }
  ReferenceFrame joints;
  joints.kind = ReferenceFrame::Kind::mean_axis;
  joints.rigid = rigid_motions(structure);
  for (Eigen::Index j = 0; j < seen.cols(); ++j) {
    const Eigen::VectorXd weights = rows * seen.col(j);
    joints.functionals.push_back(field(structure));
    Vec f = joints.functionals.back();
    PetscInt first = 0, end = 0;
    check(VecGetOwnershipRange(f, &first, &end));
    for (std::size_t i = 0; i < constrained.size(); ++i)
      if (constrained[i] >= first && constrained[i] < end)
        check(VecSetValue(f, constrained[i],
                          weights[static_cast<Eigen::Index>(i)] * (constrained[i] % n >= d ? length : 1),
                          INSERT_VALUES));
    check(VecAssemblyBegin(f));
    check(VecAssemblyEnd(f));
  }
  free.bottomRows(motions - d) /= length;
  const petsc::MatHandle M = mass(structure, {});
  const petsc::VecHandle rigid = field(structure);
  for (Eigen::Index j = 0; j < free.cols(); ++j) {
    check(VecSet(rigid, 0));
    add(rigid, free.col(j), joints.rigid);
    joints.functionals.push_back(field(structure));
    check(MatMult(M, rigid, joints.functionals.back()));
  }
  set_inverse(structure, joints);
  return joints;
}

Eigen::MatrixXd mass_seen(const Structure& structure, const ReferenceFrame& joints,
                          const std::vector<petsc::VecHandle>& V) {
  const petsc::MatHandle M = mass(structure, {});
  const petsc::VecHandle force = field(structure);
  std::vector<petsc::VecHandle> vibrations;
  for (const petsc::VecHandle& column : V) {
    vibrations.push_back(field(structure));
    check(VecCopy(column, vibrations.back()));
    to_frame(joints, vibrations.back());
  }
  const auto k = static_cast<Eigen::Index>(V.size());
  Eigen::MatrixXd products(k, k);
  for (Eigen::Index j = 0; j < k; ++j) {
    check(MatMult(M, vibrations[j], force));
    products.col(j) = dots(force, vibrations);
  }
  return 0.5 * (products + products.transpose());
}

}  // namespace floe::fem
