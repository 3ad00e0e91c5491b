#include "floe/fem/assembly.h"

#include <algorithm>

#include "node_graph.h"

namespace floe::fem {

using petsc::check;

namespace {

petsc::MatHandle empty_matrix(const Structure& structure) {
  petsc::MatHandle A;
  check(MatCreate(structure.mesh.comm, A.out()));
  check(MatSetSizes(A, structure.owned_dofs(), structure.owned_dofs(), structure.dofs(), structure.dofs()));
  check(MatSetBlockSize(A, structure.dofs_per_node));
  check(MatSetType(A, MATSBAIJ));
  const NodeGraph& graph = *structure.graph;
  check(MatSeqSBAIJSetPreallocation(A, structure.dofs_per_node, 0, graph.own.data()));
  check(MatMPISBAIJSetPreallocation(A, structure.dofs_per_node, 0, graph.own.data(), 0, graph.other.data()));
  check(MatSetOption(A, MAT_IGNORE_LOWER_TRIANGULAR, PETSC_TRUE));
  check(MatSetOption(A, MAT_SYMMETRIC, PETSC_TRUE));
  check(MatSetOption(A, MAT_SYMMETRY_ETERNAL, PETSC_TRUE));
  return A;
}

/// Empties the rows and columns of held dofs.
void hold(const Structure& structure, const Conditions& conditions, const std::vector<int>& dofs, Eigen::MatrixXd& A) {
  if (conditions.empty()) return;
  for (std::size_t i = 0; i < dofs.size(); ++i)
    if (std::binary_search(conditions.begin(), conditions.end(), structure.global_dof(dofs[i])))
      A.row(i).setZero(), A.col(i).setZero();
}

}  // namespace

petsc::MatHandle assemble(const Structure& structure, const Conditions& conditions, double diagonal, double k,
                          double m) {
  petsc::MatHandle A = empty_matrix(structure);
  double largest = 0;
  for (const Mesh::Cell& cell : structure.mesh.cells) {
    Eigen::MatrixXd Ae = structure.matrix(cell, k, m);
    largest = std::max(largest, Ae.diagonal().cwiseAbs().maxCoeff());
    hold(structure, conditions, structure.cell_dofs(cell), Ae);
    PetscInt nodes[4];
    PetscInt count = 0;
    for (int node : cell.nodes()) nodes[count++] = structure.mesh.global_node(node);
    check(MatSetValuesBlocked(A, count, nodes, count, nodes, Ae.data(), ADD_VALUES));  // symmetric: either major
  }
  MPI_Allreduce(MPI_IN_PLACE, &largest, 1, MPI_DOUBLE, MPI_MAX, structure.mesh.comm);
  PetscInt first = 0, end = 0;
  check(MatGetOwnershipRange(A, &first, &end));
  for (PetscInt dof : conditions)
    if (dof >= first && dof < end) check(MatSetValue(A, dof, dof, diagonal * largest, ADD_VALUES));
  check(MatAssemblyBegin(A, MAT_FINAL_ASSEMBLY));
  check(MatAssemblyEnd(A, MAT_FINAL_ASSEMBLY));
  return A;
}

petsc::MatHandle stiffness(const Structure& structure, const Conditions& conditions) {
  petsc::MatHandle K = assemble(structure, conditions, 1, 1, 0);
  check(MatSetOption(K, MAT_SPD, PETSC_TRUE));
  return K;
}

petsc::MatHandle mass(const Structure& structure, const Conditions& conditions) {
  return assemble(structure, conditions, 0, 0, 1);
}

petsc::VecHandle stiffness_derivative(const Structure& structure, Vec phi_i, Vec phi_j) {
  const Eigen::VectorXd a = structure.exchange.gather(phi_i), b = structure.exchange.gather(phi_j);
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(a.size());
  for (const Mesh::Cell& cell : structure.mesh.cells) {
    const std::vector<int> dofs = structure.cell_dofs(cell);
    sum(dofs) += stiffness_derivative(structure.maps(cell), a(dofs), b(dofs));
  }
  petsc::VecHandle f = field(structure);
  structure.exchange.add(sum, f);
  return f;
}

std::vector<petsc::VecHandle> stiffness_derivatives(const Structure& structure,
                                                    const std::vector<petsc::VecHandle>& fields,
                                                    const std::vector<std::array<int, 2>>& pairs) {
  Eigen::MatrixXd Q(structure.local_dofs(), fields.size());
  for (std::size_t j = 0; j < fields.size(); ++j) Q.col(j) = structure.exchange.gather(fields[j]);
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(structure.local_dofs(), pairs.size());
  for (const Mesh::Cell& cell : structure.mesh.cells) {
    const std::vector<int> dofs = structure.cell_dofs(cell);
    const Eigen::MatrixXd f = stiffness_derivatives(structure.maps(cell), Q(dofs, Eigen::all), pairs);
    for (std::size_t i = 0; i < dofs.size(); ++i) sum.row(dofs[i]) += f.row(i);
  }
  std::vector<petsc::VecHandle> all;
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    all.push_back(field(structure));
    structure.exchange.add(sum.col(p), all.back());
  }
  return all;
}

void hold(Vec field, const Conditions& conditions) {
  PetscInt first = 0, end = 0;
  check(VecGetOwnershipRange(field, &first, &end));
  double* values = nullptr;
  check(VecGetArray(field, &values));
  for (PetscInt dof : conditions)
    if (dof >= first && dof < end) values[dof - first] = 0;
  check(VecRestoreArray(field, &values));
}

}  // namespace floe::fem
