#include "floe/reference/modal_damping.h"

#include <algorithm>
#include <iterator>
#include <numeric>

#include "floe/dynamics/damping.h"
#include "floe/petsc/values.h"

namespace floe::reference {

namespace {

std::vector<int> from(int first, int count) {
  std::vector<int> all(static_cast<std::size_t>(count));
  std::iota(all.begin(), all.end(), first);
  return all;
}

}  // namespace

std::vector<std::unique_ptr<dynamics::Term>> modal_rows(const fem::Structure& structure,
                                                        const std::vector<petsc::VecHandle>& forces,
                                                        const fem::Conditions& constrained, int multipliers,
                                                        const NodeCoordinates& nodes) {
  const int n = structure.dofs_per_node, k = static_cast<int>(forces.size());
  const fem::Mesh& mesh = structure.mesh;
  Eigen::MatrixXd f(k, n * mesh.owned_nodes);
  for (int i = 0; i < k; ++i) {
    petsc::Values own(forces[i]);
    std::copy(own.begin(), own.begin() + f.cols(), f.row(i).begin());
  }
  std::vector<std::unique_ptr<dynamics::Term>> terms;
  for (PetscInt node = 0; node < mesh.owned_nodes; ++node) {
    std::vector<int> coordinates;
    std::vector<Eigen::Index> columns;
    for (int d = 0; d < n; ++d) {
      const PetscInt dof = n * (mesh.first_node + node) + d;
      if (std::binary_search(constrained.begin(), constrained.end(), dof) || f.col(n * node + d).isZero(0)) continue;
      coordinates.push_back(nodes.of_local_node(static_cast<int>(node)) + d);
      columns.push_back(n * node + d);
    }
    if (columns.empty()) continue;
    Eigen::MatrixXd C = f(Eigen::all, columns);
    for (int multiplier : from(multipliers, k)) coordinates.push_back(multiplier);
    terms.push_back(std::make_unique<LinearConstraint>(std::move(coordinates), std::move(C)));
  }
  return terms;
}

std::vector<std::unique_ptr<dynamics::Term>> modal_dampers(const Eigen::VectorXd& viscosity, int y, int multipliers) {
  const int k = static_cast<int>(viscosity.size());
  std::vector<int> coordinates = from(y, k);
  std::vector<std::unique_ptr<dynamics::Term>> terms;
  terms.push_back(std::make_unique<dynamics::LinearDamping>(coordinates, viscosity.asDiagonal()));
  for (int multiplier : from(multipliers, k)) coordinates.push_back(multiplier);
  terms.push_back(std::make_unique<LinearConstraint>(std::move(coordinates), -Eigen::MatrixXd::Identity(k, k)));
  return terms;
}

std::vector<std::unique_ptr<dynamics::Term>> modal_damping_terms(const fem::Structure& structure,
                                                                 const ModalDamping& damping,
                                                                 const NodeCoordinates& nodes) {
  auto terms = modal_rows(structure, damping.forces, damping.constrained, damping.multipliers, nodes);
  int rank = 0, size = 1;
  MPI_Comm_rank(structure.mesh.comm, &rank);
  MPI_Comm_size(structure.mesh.comm, &size);
  if (rank + 1 == size)
    std::ranges::move(modal_dampers(damping.viscosity, damping.y, damping.multipliers), std::back_inserter(terms));
  return terms;
}

Eigen::VectorXd modal_coordinates(const std::vector<petsc::VecHandle>& forces, Vec q) {
  Eigen::VectorXd y = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(forces.size()));
  for (Eigen::Index i = 0; q && i < y.size(); ++i) petsc::check(VecDot(forces[i], q, &y[i]));
  return y;
}

}  // namespace floe::reference
