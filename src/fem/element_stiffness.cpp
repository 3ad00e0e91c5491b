#include "floe/fem/element_stiffness.h"

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
        const Eigen::Vector3d turn = column.segment<3>(3), arm = arms.col(i);
        column.segment<3>(dofs * i) -= turn.cross(arm);
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
  for (const Mesh::Cell& cell : structure.mesh.cells) {
    const Eigen::MatrixXd K = structure.matrix(cell, 1, 0);
    largest_ = std::max(largest_, K.diagonal().cwiseAbs().maxCoeff());
    if (structure.dimension() == 2) K_.push_back(K);
  }
  MPI_Allreduce(MPI_IN_PLACE, &largest_, 1, MPI_DOUBLE, MPI_MAX, structure.mesh.comm);
}

template <class Sink>
void ElementStiffness::each(Vec q, Sink&& sink) const {
  const Eigen::VectorXd all = structure_.exchange.gather(q);
  const Eigen::Index dofs = structure_.dofs_per_node;
  Eigen::VectorXd own, force;
  for (std::size_t c = 0; c < structure_.mesh.cells.size(); ++c) {
    const Mesh::Cell& cell = structure_.mesh.cells[c];
    const auto nodes = cell.nodes();
    own.resize(dofs * static_cast<Eigen::Index>(nodes.size()));
    for (std::size_t i = 0; i < nodes.size(); ++i) own.segment(dofs * i, dofs) = all.segment(dofs * nodes[i], dofs);
    take_rigid_motion(own, arms(structure_.mesh, cell));
    if (K_.empty())
      force.noalias() = structure_.matrix(cell, 1, 0) * own;
    else
      force.noalias() = K_[c] * own;
    sink(nodes, own, force);
  }
}

void ElementStiffness::multiply(Vec q, Vec f) const {
  const Eigen::Index dofs = structure_.dofs_per_node;
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(structure_.local_dofs());
  each(q, [&](const auto& nodes, const Eigen::VectorXd&, const Eigen::VectorXd& force) {
    for (std::size_t i = 0; i < nodes.size(); ++i) sum.segment(dofs * nodes[i], dofs) += force.segment(dofs * i, dofs);
  });
  check(VecSet(f, 0));
  structure_.exchange.add(sum, f);
}

double ElementStiffness::strain_energy(Vec q) const {
  double energy = 0;
  each(q, [&](const auto&, const Eigen::VectorXd& own, const Eigen::VectorXd& force) { energy += own.dot(force) / 2; });
  MPI_Allreduce(MPI_IN_PLACE, &energy, 1, MPI_DOUBLE, MPI_SUM, structure_.mesh.comm);
  return energy;
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

PetscErrorCode multiply(Mat K, Vec x, Vec y) {
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
  shell.release();
  check(MatShellSetOperation(K, MATOP_MULT, reinterpret_cast<void (*)()>(multiply)));
  check(MatShellSetOperation(K, MATOP_DESTROY, reinterpret_cast<void (*)()>(destroy)));
  check(MatSetOption(K, MAT_SPD, PETSC_TRUE));
  return K;
}

}  // namespace floe::fem
