#include "floe/fem/assembly.h"

#include <petsc/private/petscimpl.h>

#include <algorithm>

#include "assemble_cells.h"
#include "floe/fem/field_rows.h"
#include "floe/petsc/stage.h"
#include "kept.h"
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

/// Empties the rows and columns of constrained dofs.
void hold(const Structure& structure, const Conditions& conditions, const std::vector<int>& dofs, Eigen::MatrixXd& A) {
  if (conditions.empty()) return;
  for (std::size_t i = 0; i < dofs.size(); ++i)
    if (std::binary_search(conditions.begin(), conditions.end(), structure.global_dof(dofs[i])))
      A.row(i).setZero(), A.col(i).setZero();
}

}  // namespace

double for_each_matrix(const Structure& structure, const Conditions& conditions, const MatrixOfCell& matrix_of,
                       const MatrixSink& add) {
  double largest = 0;
  for (const Mesh::Cell& cell : structure.mesh.cells) {
    Eigen::MatrixXd Ae = matrix_of(cell);
    largest = std::max(largest, Ae.diagonal().cwiseAbs().maxCoeff());
    hold(structure, conditions, structure.cell_dofs(cell), Ae);
    add(cell, Ae);
  }
  MPI_Allreduce(MPI_IN_PLACE, &largest, 1, MPI_DOUBLE, MPI_MAX, structure.mesh.comm);
  return largest;
}

petsc::MatHandle assemble_cells(const Structure& structure, const Conditions& conditions, double diagonal,
                                const MatrixOfCell& matrix_of) {
  const petsc::Stage stage("assembly");
  petsc::MatHandle A = empty_matrix(structure);
  const double largest =
      for_each_matrix(structure, conditions, matrix_of, [&](const Mesh::Cell& cell, const Eigen::MatrixXd& Ae) {
        PetscInt nodes[2 * mesh::most_nodes];
        PetscInt count = 0;
        for (int node : cell.nodes()) nodes[count++] = structure.mesh.global_node(node);
        check(MatSetValuesBlocked(A, count, nodes, count, nodes, Ae.data(), ADD_VALUES));  // symmetric: either major
      });
  PetscInt first = 0, end = 0;
  check(MatGetOwnershipRange(A, &first, &end));
  for (PetscInt dof : conditions)
    if (dof >= first && dof < end) check(MatSetValue(A, dof, dof, diagonal * largest, ADD_VALUES));
  check(MatAssemblyBegin(A, MAT_FINAL_ASSEMBLY));
  check(MatAssemblyEnd(A, MAT_FINAL_ASSEMBLY));
  return A;
}

petsc::MatHandle assemble(const Structure& structure, const Conditions& conditions, double diagonal, double k,
                          double m) {
  return assemble_cells(structure, conditions, diagonal,
                        [&](const Mesh::Cell& cell) { return structure.matrix(cell, k, m); });
}

petsc::MatHandle tangent_stiffness(const Structure& structure, const Conditions& conditions, Vec q) {
  const Eigen::VectorXd all = structure.exchange.gather(q);
  return assemble_cells(structure, conditions, 1, [&](const Mesh::Cell& cell) {
    return structure.maps(cell).tangent(all(structure.cell_dofs(cell)));
  });
}

petsc::MatHandle stiffness(const Structure& structure, const Conditions& conditions) {
  petsc::MatHandle K = assemble(structure, conditions, 1, 1, 0);
  check(MatSetOption(K, MAT_SPD, PETSC_TRUE));
  return K;
}

namespace {

PetscObjectState changes(Mat A) {
  PetscObjectState state = 0;
  check(PetscObjectStateGet(reinterpret_cast<PetscObject>(A), &state));
  return state;
}

/// The one that is shared.
Mat unconstrained_mass(const Structure& structure) {
  Kept& kept = *structure.kept;
  if (kept.mass && changes(kept.mass) == kept.mass_changes) return kept.mass;
  kept.mass = assemble(structure, {}, 0, 0, 1);
  kept.mass_changes = changes(kept.mass);
  return kept.mass;
}

}  // namespace

petsc::MatHandle mass(const Structure& structure, const Conditions& conditions) {
  Mat shared = unconstrained_mass(structure);
  if (conditions.empty()) {
    check(PetscObjectReference(reinterpret_cast<PetscObject>(shared)));
    return petsc::MatHandle(shared);
  }
  // A MatDuplicate of MATSBAIJ would multiply half as fast: it forgets the kernel for its size of blocks
  // (PETSc 3.18.5).
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
  std::vector<petsc::VecHandle> columns;
  if (pairs.empty()) return columns;
  const petsc::MatHandle loads = derivative_loads(structure, gather(structure, fields), pairs);
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    columns.push_back(field(structure));
    check(MatGetColumnVector(loads, columns.back(), static_cast<PetscInt>(p)));
    check(VecScale(columns.back(), -1));
  }
  return columns;
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
