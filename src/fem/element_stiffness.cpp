#include "floe/fem/element_stiffness.h"

#include "floe/fem/field_rows.h"
#include "floe/fem/pressure.h"

namespace floe::fem {

using petsc::check;

void take_rigid_motion(Eigen::Ref<Eigen::MatrixXd> q, const Eigen::Matrix3Xd& arms) {
  const Eigen::Index dofs = q.rows() / arms.cols();
  for (Eigen::Index j = 0; j < q.cols(); ++j) {
    auto column = q.col(j);
    for (Eigen::Index i = arms.cols() - 1; i >= 0; --i) {  // the first node last: the others are measured from it
      column.segment(dofs * i, dofs) -= column.head(dofs);
      if (dofs == 3) {
        column[3 * i] += column[2] * arms(1, i);
        column[3 * i + 1] -= column[2] * arms(0, i);
      } else {
        const Eigen::Vector3d rotation = column.segment<3>(3), arm = arms.col(i);
        column.segment<3>(dofs * i) -= rotation.cross(arm);
      }
    }
  }
}

Eigen::Matrix3Xd arms(const Mesh& mesh, const Mesh::Cell& cell) {
  const auto nodes = cell.nodes();
  Eigen::Matrix3Xd arms(3, nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) arms.col(i) = mesh.positions[nodes[i]] - mesh.positions[nodes[0]];
  return arms;
}

ElementStiffness::ElementStiffness(const Structure& structure) : structure_(structure) {
  if (structure.dimension() == 2)
    for (const Mesh::Cell& cell : structure.mesh.cells) K_.push_back(structure.matrix(cell, 1, 0));
}

double ElementStiffness::largest_diagonal() const {
  if (largest_ >= 0) return largest_;
  largest_ = 0;
  for (const Mesh::Cell& cell : structure_.mesh.cells)
    largest_ = std::max(largest_, structure_.matrix(cell, 1, 0).diagonal().cwiseAbs().maxCoeff());
  MPI_Allreduce(MPI_IN_PLACE, &largest_, 1, MPI_DOUBLE, MPI_MAX, structure_.mesh.comm);
  return largest_;
}

template <class Sink>
void ElementStiffness::each_line(const FieldRows& X, Sink&& sink) const {
  const Eigen::Index dofs = structure_.dofs_per_node;
  Eigen::MatrixXd own, force;
  for (std::size_t c = 0; c < structure_.mesh.cells.size(); ++c) {
    const Mesh::Cell& cell = structure_.mesh.cells[c];
    if (is_shell(cell)) continue;
    const auto nodes = cell.nodes();
    own.resize(dofs * static_cast<Eigen::Index>(nodes.size()), X.cols());
    for (std::size_t i = 0; i < nodes.size(); ++i) own.middleRows(dofs * i, dofs) = X.middleRows(dofs * nodes[i], dofs);
    if (!cell.spins()) take_rigid_motion(own, arms(structure_.mesh, cell));  // else no node has all of it
    if (K_.empty())
      force.noalias() = structure_.matrix(cell, 1, 0) * own;
    else
      force.noalias() = K_[c] * own;
    sink(nodes, own, force);
  }
}

template <class Sink>
void ElementStiffness::each_shell(const FieldRows& X, Sink&& sink) const {
  if (structure_.dimension() == 2) return;
  const DofRanges ranges = dof_ranges(structure_, X);
  std::vector<PieceRows> pieces;
  Strained strained;
  FieldRows values;
  const auto hand = [&](const PieceRows& piece, const SmallRows& rows) {
    if (values.rows() < rows.rows()) values.resize(rows.rows(), X.cols());
    const ColumnRange range = fem::multiply(rows, strained, structure_.dofs_per_node, values.data());
    if (!range.empty()) sink(piece, rows, values.topRows(rows.rows()));
  };
  for (const Mesh::Cell& cell : structure_.mesh.cells) {
    if (!is_shell(cell)) continue;
    piece_rows(structure_, cell, {.bending = true, .strain = true}, pieces);
    for (const PieceRows& piece : pieces) {
      take_strained(structure_, piece, X, ranges, strained);
      hand(piece, piece.bending);
      for (const StrainRows& point : piece.strain) hand(piece, point.L);
    }
  }
}

void ElementStiffness::add_forces(const FieldRows& X, FieldRows& sums) const {
  const Eigen::Index dofs = structure_.dofs_per_node;
  each_line(X, [&](const auto& nodes, const Eigen::MatrixXd&, const Eigen::MatrixXd& force) {
    for (std::size_t i = 0; i < nodes.size(); ++i)
      sums.middleRows(dofs * nodes[i], dofs) += force.middleRows(dofs * i, dofs);
  });
  each_shell(X, [&](const PieceRows& piece, const SmallRows& rows, const auto& values) {
    add_transposed(structure_, piece, rows, values.data(), sums);
  });
}

Eigen::MatrixXd ElementStiffness::gram(const FieldRows& X) const {
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(X.cols(), X.cols());
  each_line(X, [&](const auto&, const Eigen::MatrixXd& own, const Eigen::MatrixXd& force) {
    sum.noalias() += own.transpose() * force;
  });
  each_shell(
      X, [&](const PieceRows&, const SmallRows&, const auto& values) { sum.noalias() += values.transpose() * values; });
  MPI_Allreduce(MPI_IN_PLACE, sum.data(), static_cast<int>(sum.size()), MPI_DOUBLE, MPI_SUM, structure_.mesh.comm);
  return (sum + sum.transpose()) / 2;
}

void ElementStiffness::multiply(Vec q, Vec f) const {
  const FieldRows X = gather(structure_, 1, [&](Eigen::Index, double* local) { structure_.exchange.gather(q, local); });
  FieldRows sum = FieldRows::Zero(X.rows(), 1);
  add_forces(X, sum);
  check(VecSet(f, 0));
  for_each_field(structure_, sum, [&](Eigen::Index, const double* local) { structure_.exchange.add(local, f); });
}

double ElementStiffness::strain_energy(Vec q) const {
  return gram(gather(structure_, 1, [&](Eigen::Index, double* local) { structure_.exchange.gather(q, local); }))(0, 0) /
         2;
}

namespace {

struct Shell {
  std::shared_ptr<const ElementStiffness> elements;
  Conditions conditions;
  petsc::VecHandle free;  // x, zero at the conditions
};

Shell* shell_of(Mat K) {
  void* context = nullptr;
  check(MatShellGetContext(K, &context));
  return static_cast<Shell*>(context);
}

PetscErrorCode multiply_shell(Mat K, Vec x, Vec y) {
  return petsc::Guard().run([&] {
    Shell& shell = *shell_of(K);
    check(VecCopy(x, shell.free));
    hold(shell.free, shell.conditions);
    shell.elements->multiply(shell.free, y);
    hold(y, shell.conditions);
    check(VecAXPY(shell.free, -1, x));  // -x at the conditions, 0 elsewhere
    check(VecAXPY(y, -shell.elements->largest_diagonal(), shell.free));
  });
}

PetscErrorCode destroy(Mat K) {
  return petsc::Guard().run([&] { delete shell_of(K); });
}

}  // namespace

petsc::MatHandle stiffness_operator(std::shared_ptr<const ElementStiffness> elements, const Conditions& conditions) {
  const Structure& structure = elements->structure();
  const PetscInt owned = structure.owned_dofs(), n = structure.dofs();
  petsc::MatHandle K;
  auto shell = std::make_unique<Shell>();
  shell->free = field(structure);
  shell->conditions = conditions;
  shell->elements = std::move(elements);
  check(MatCreateShell(structure.mesh.comm, owned, owned, n, n, shell.get(), K.out()));
  static_cast<void>(shell.release());  // K destroys it
  check(MatShellSetOperation(K, MATOP_MULT, reinterpret_cast<void (*)()>(multiply_shell)));
  check(MatShellSetOperation(K, MATOP_DESTROY, reinterpret_cast<void (*)()>(destroy)));
  check(MatSetOption(K, MAT_SPD, PETSC_TRUE));
  return K;
}

}  // namespace floe::fem
