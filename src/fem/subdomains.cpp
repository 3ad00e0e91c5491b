#include "floe/fem/subdomains.h"

#include <algorithm>

#include "assemble_cells.h"
#include "floe/petsc/stage.h"

namespace floe::fem {

using petsc::check;

namespace {

/// The nodes of this rank's subdomain.
struct Subdomain {
  std::vector<PetscInt> global;  ///< of each node of the subdomain
  std::vector<PetscInt> number;  ///< of each local node in the subdomain; -1: in no cell of this rank
};

/// Those that this rank's cells act on, and its own that no rank's cells act on. Collective.
Subdomain subdomain_of(const Structure& structure) {
  const Mesh& mesh = structure.mesh;
  const int n = structure.dofs_per_node;
  Eigen::VectorXd touched = Eigen::VectorXd::Zero(structure.local_dofs());
  for (const Mesh::Cell& cell : mesh.cells)
    for (int node : cell.nodes()) touched[n * node] = 1;
  const petsc::VecHandle sum = field(structure);
  structure.exchange.add(touched, sum);
  const Eigen::VectorXd by_any = structure.exchange.gather(sum);
  Subdomain subdomain;
  subdomain.number.assign(mesh.positions.size(), -1);
  for (int node = 0; node < static_cast<int>(mesh.positions.size()); ++node) {
    const bool alone = node < mesh.owned_nodes && by_any[n * node] == 0;
    if (touched[n * node] == 0 && !alone) continue;
    subdomain.number[node] = static_cast<PetscInt>(subdomain.global.size());
    subdomain.global.push_back(mesh.global_node(node));
  }
  return subdomain;
}

/// Neighbours of each node of the subdomain, itself included.
std::vector<PetscInt> neighbour_counts(const Mesh& mesh, const Subdomain& subdomain) {
  std::vector<std::vector<PetscInt>> neighbours(subdomain.global.size());
  for (const Mesh::Cell& cell : mesh.cells)
    for (int a : cell.nodes())
      for (int b : cell.nodes()) neighbours[subdomain.number[a]].push_back(subdomain.number[b]);
  std::vector<PetscInt> counts;
  for (std::vector<PetscInt>& row : neighbours) {
    row.push_back(static_cast<PetscInt>(counts.size()));
    std::sort(row.begin(), row.end());
    counts.push_back(static_cast<PetscInt>(std::unique(row.begin(), row.end()) - row.begin()));
  }
  return counts;
}

petsc::MatHandle empty_matrix(const Structure& structure, const Subdomain& subdomain) {
  const int n = structure.dofs_per_node;
  petsc::MappingHandle mapping;
  petsc::MatHandle A;
  Mat own = nullptr;
  check(ISLocalToGlobalMappingCreate(structure.mesh.comm, n, static_cast<PetscInt>(subdomain.global.size()),
                                     subdomain.global.data(), PETSC_COPY_VALUES, mapping.out()));
  check(MatCreateIS(structure.mesh.comm, n, structure.owned_dofs(), structure.owned_dofs(), structure.dofs(),
                    structure.dofs(), mapping, mapping, A.out()));
  check(MatISGetLocalMat(A, &own));
  const std::vector<PetscInt> counts = neighbour_counts(structure.mesh, subdomain);
  check(MatXAIJSetPreallocation(own, n, counts.data(), nullptr, nullptr, nullptr));
  check(MatSetOption(own, MAT_SYMMETRIC, PETSC_TRUE));
  check(MatISRestoreLocalMat(A, &own));
  return A;
}

}  // namespace

petsc::MatHandle assemble_subdomains(const Structure& structure, const Conditions& conditions, double k, double m) {
  const petsc::Stage stage("assembly");
  const Subdomain subdomain = subdomain_of(structure);
  petsc::MatHandle A = empty_matrix(structure, subdomain);
  const double largest = for_each_matrix(
      structure, conditions, [&](const Mesh::Cell& cell) { return structure.matrix(cell, k, m); },
      [&](const Mesh::Cell& cell, const Eigen::MatrixXd& Ae) {
        PetscInt nodes[2 * mesh::most_nodes];
        PetscInt count = 0;
        for (int node : cell.nodes()) nodes[count++] = subdomain.number[node];
        check(MatSetValuesBlockedLocal(A, count, nodes, count, nodes, Ae.data(), ADD_VALUES));
      });
  const int n = structure.dofs_per_node;
  for (PetscInt i = 0; i < n * static_cast<PetscInt>(subdomain.global.size()); ++i)
    if (std::binary_search(conditions.begin(), conditions.end(), n * subdomain.global[i / n] + i % n))
      check(MatSetValueLocal(A, i, i, largest, ADD_VALUES));
  check(MatAssemblyBegin(A, MAT_FINAL_ASSEMBLY));
  check(MatAssemblyEnd(A, MAT_FINAL_ASSEMBLY));
  check(MatSetOption(A, MAT_SYMMETRIC, PETSC_TRUE));
  check(MatSetOption(A, MAT_SPD, PETSC_TRUE));
  return A;
}

}  // namespace floe::fem
