#include "floe/reference/modal_damping.h"

#include <algorithm>

#include "floe/dynamics/damping.h"
#include "floe/petsc/values.h"

namespace floe::reference {

std::vector<std::unique_ptr<dynamics::Term>> modal_damping_terms(const fem::Structure& structure,
                                                                 const ModalDamping& damping,
                                                                 const NodeCoordinates& nodes) {
  const int n = structure.dofs_per_node, k = static_cast<int>(damping.forces.size());
  const fem::Mesh& mesh = structure.mesh;
  const auto from = [k](int first) {
    std::vector<int> all(k);
    for (int i = 0; i < k; ++i) all[i] = first + i;
    return all;
  };
  Eigen::MatrixXd f(k, n * mesh.owned_nodes);
  for (int i = 0; i < k; ++i) {
    petsc::Values own(damping.forces[i]);
    std::copy(own.begin(), own.begin() + f.cols(), f.row(i).begin());
  }
  std::vector<std::unique_ptr<dynamics::Term>> terms;
  for (PetscInt node = 0; node < mesh.owned_nodes; ++node) {
    std::vector<int> coordinates;
    std::vector<Eigen::Index> columns;
    for (int d = 0; d < n; ++d) {
      const PetscInt dof = n * (mesh.first_node + node) + d;
      if (std::binary_search(damping.constrained.begin(), damping.constrained.end(), dof) ||
          f.col(n * node + d).isZero(0))
        continue;
      coordinates.push_back(nodes.of_local_node(static_cast<int>(node)) + d);
      columns.push_back(n * node + d);
    }
    if (columns.empty()) continue;
    Eigen::MatrixXd C = f(Eigen::all, columns);
    for (int multiplier : from(damping.multipliers)) coordinates.push_back(multiplier);
    terms.push_back(std::make_unique<LinearConstraint>(std::move(coordinates), std::move(C)));
  }
  int rank = 0, size = 1;
  MPI_Comm_rank(mesh.comm, &rank);
  MPI_Comm_size(mesh.comm, &size);
  if (rank + 1 < size) return terms;
  std::vector<int> coordinates = from(damping.y);
  terms.push_back(std::make_unique<dynamics::LinearDamping>(coordinates, damping.viscosity.asDiagonal()));
  for (int multiplier : from(damping.multipliers)) coordinates.push_back(multiplier);
  terms.push_back(std::make_unique<LinearConstraint>(std::move(coordinates), -Eigen::MatrixXd::Identity(k, k)));
  return terms;
}

Eigen::VectorXd modal_coordinates(const ModalDamping& damping, Vec q) {
  Eigen::VectorXd y = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(damping.forces.size()));
  for (Eigen::Index i = 0; q && i < y.size(); ++i) petsc::check(VecDot(damping.forces[i], q, &y[i]));
  return y;
}

}  // namespace floe::reference
