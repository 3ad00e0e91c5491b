#include "floe/reference/mass_damping.h"

#include <algorithm>

#include "floe/dynamics/damping.h"
#include "floe/petsc/values.h"

namespace floe::reference {
namespace {

using petsc::check;

bool is_constrained(const fem::Conditions& constrained, PetscInt dof) {
  return std::binary_search(constrained.begin(), constrained.end(), dof);
}

bool last_rank(MPI_Comm comm) {
  int rank = 0, size = 1;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &size);
  return rank == size - 1;
}

std::vector<int> with(std::vector<int> all, int first, int count) {
  for (int i = 0; i < count; ++i) all.push_back(first + i);
  return all;
}

/// alpha M of every element on its free dofs and s.
void add_elements(const fem::Structure& structure, const MassDamping& damping, const NodeCoordinates& nodes,
                  std::vector<std::unique_ptr<dynamics::Term>>& terms) {
  const int n = structure.dofs_per_node, r = damping.motion < 0 ? 0 : structure.rigid_motion_count();
  std::vector<Eigen::VectorXd> rigid;
  for (int i = 0; i < r; ++i) rigid.push_back(structure.exchange.gather(damping.joints.rigid[i]));
  for (const fem::Mesh::Cell& cell : structure.mesh.cells) {
    const std::vector<int> dofs = structure.cell_dofs(cell);
    std::vector<int> coordinates;
    std::vector<Eigen::Index> free;
    for (std::size_t i = 0; i < dofs.size(); ++i) {
      if (is_constrained(damping.constrained, structure.global_dof(dofs[i]))) continue;
      free.push_back(static_cast<Eigen::Index>(i));
      coordinates.push_back(nodes.of_local_node(dofs[i] / n) + dofs[i] % n);
    }
    const auto count = static_cast<Eigen::Index>(free.size());
    Eigen::MatrixXd B = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(dofs.size()), count + r);
    for (Eigen::Index i = 0; i < count; ++i) B(free[i], i) = 1;
    for (int i = 0; i < r; ++i) B.col(count + i) = -rigid[i](dofs);
    const Eigen::MatrixXd M = structure.maps(cell).mass_matrix();
    terms.push_back(std::make_unique<dynamics::LinearDamping>(with(coordinates, damping.motion, r),
                                                              damping.alpha * B.transpose() * M * B));
  }
}

/// f'(q - Phi_r s) = 0, node by node, and that of s.
void add_constraints(const fem::Structure& structure, const MassDamping& damping, const NodeCoordinates& nodes,
                     std::vector<std::unique_ptr<dynamics::Term>>& terms) {
  const int n = structure.dofs_per_node, r = structure.rigid_motion_count();
  const PetscInt first = structure.mesh.first_node;
  Eigen::MatrixXd f(r, n * structure.mesh.owned_nodes);
  for (int i = 0; i < r; ++i) {
    petsc::Values own(damping.joints.functionals[i]);
    std::copy(own.begin(), own.begin() + f.cols(), f.row(i).begin());
  }
  for (PetscInt node = 0; node < structure.mesh.owned_nodes; ++node) {
    std::vector<int> coordinates;
    std::vector<Eigen::Index> columns;
    for (int d = 0; d < n; ++d) {
      if (is_constrained(damping.constrained, n * (first + node) + d) || f.col(n * node + d).isZero(0)) continue;
      coordinates.push_back(nodes.of_local_node(static_cast<int>(node)) + d);
      columns.push_back(n * node + d);
    }
    if (columns.empty()) continue;
    Eigen::MatrixXd C = f(Eigen::all, columns);
    terms.push_back(std::make_unique<LinearConstraint>(with(coordinates, damping.multipliers, r), std::move(C)));
  }
  if (last_rank(structure.mesh.comm))
    terms.push_back(std::make_unique<LinearConstraint>(with(with({}, damping.motion, r), damping.multipliers, r),
                                                       -damping.joints.inverse.inverse()));
}

}  // namespace

bool moves_nothing(const fem::Structure& structure, const fem::ReferenceFrame& joints,
                   const fem::Conditions& constrained) {
  const int n = structure.dofs_per_node;
  int moves = 0;
  for (const petsc::VecHandle& f : joints.functionals) {
    petsc::Values own(f);
    double greatest = 0, free = 0;
    check(VecNorm(f, NORM_INFINITY, &greatest));
    for (PetscInt dof = own.first; dof < own.first + n * structure.mesh.owned_nodes; ++dof)
      if (!is_constrained(constrained, dof)) free = std::max(free, std::abs(own[dof]));
    if (free > 1e-12 * greatest) moves = 1;
  }
  MPI_Allreduce(MPI_IN_PLACE, &moves, 1, MPI_INT, MPI_MAX, structure.mesh.comm);
  return moves == 0;
}

std::vector<std::unique_ptr<dynamics::Term>> mass_damping_terms(const fem::Structure& structure,
                                                                const MassDamping& damping,
                                                                const NodeCoordinates& nodes) {
  std::vector<std::unique_ptr<dynamics::Term>> terms;
  add_elements(structure, damping, nodes, terms);
  if (damping.motion >= 0) add_constraints(structure, damping, nodes, terms);
  return terms;
}

Eigen::VectorXd rigid_part(const fem::ReferenceFrame& joints, Vec q) {
  Eigen::VectorXd values = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(joints.functionals.size()));
  if (!q) return values;
  for (std::size_t i = 0; i < joints.functionals.size(); ++i) check(VecDot(joints.functionals[i], q, &values[i]));
  return joints.inverse * values;
}

}  // namespace floe::reference
