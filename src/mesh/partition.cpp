#include "floe/mesh/partition.h"

#include <dlfcn.h>

#include "floe/mesh/exchange.h"
#include "floe/petsc/handle.h"
#include "node_graph.h"

namespace floe::mesh {
namespace {

using PartitioningHandle = petsc::Handle<MatPartitioning, MatPartitioningDestroy>;

petsc::MatHandle adjacency(const RawMesh& mesh) {
  const NodeGraph graph = node_graph(mesh);
  PetscInt *rows, *columns;  // the matrix frees them
  petsc::check(PetscMalloc1(graph.rows.size(), &rows));
  petsc::check(PetscMalloc1(graph.columns.size() + 1, &columns));
  std::copy(graph.rows.begin(), graph.rows.end(), rows);
  std::copy(graph.columns.begin(), graph.columns.end(), columns);
  petsc::MatHandle matrix;
  petsc::check(MatCreateMPIAdj(mesh.comm, static_cast<PetscInt>(mesh.positions.size()), mesh.node_count, rows, columns,
                               nullptr, matrix.out()));
  return matrix;
}

/// @throws InputError  the partitioner is PT-Scotch, of other integers than PETSc's
void check_integers(MatPartitioning partitioning) {
  MatPartitioningType type = nullptr;
  petsc::check(MatPartitioningGetType(partitioning, &type));
  const auto size = reinterpret_cast<int (*)()>(dlsym(RTLD_DEFAULT, "SCOTCH_numSizeof"));
  if (!type || std::string(type) != MATPARTITIONINGPTSCOTCH || !size || size() == static_cast<int>(sizeof(PetscInt)))
    return;
  throw InputError("option -mesh_mat_partitioning_type ptscotch: the PT-Scotch here has integers of " +
                   std::to_string(8 * size()) + " bits, PETSc of " + std::to_string(8 * sizeof(PetscInt)) +
                   "; expected metis, current, ...");
}

/// With its options.
PartitioningHandle created(MPI_Comm comm, const std::string& prefix) {
  register_metis();
  PartitioningHandle partitioning;
  petsc::check(MatPartitioningCreate(comm, partitioning.out()));
  petsc::check(PetscObjectSetOptionsPrefix(reinterpret_cast<PetscObject>(partitioning.get()), prefix.c_str()));
  petsc::check(MatPartitioningSetType(partitioning, "metis"));
  petsc::check_options(MatPartitioningSetFromOptions(partitioning), prefix + "mat_partitioning");
  check_integers(partitioning);
  return partitioning;
}

}  // namespace

void check_partitioning_options(const std::string& prefix) { created(PETSC_COMM_SELF, prefix); }

std::vector<int> partition(const RawMesh& mesh) {
  int ranks = 1;
  MPI_Comm_size(mesh.comm, &ranks);
  if (ranks == 1) return std::vector<int>(mesh.positions.size(), 0);
  const PartitioningHandle partitioning = created(mesh.comm, "mesh_");
  const petsc::MatHandle graph = adjacency(mesh);
  petsc::check(MatPartitioningSetAdjacency(partitioning, graph));
  petsc::check(MatPartitioningSetNParts(partitioning, ranks));
  petsc::IsHandle parts;
  petsc::check(MatPartitioningApply(partitioning, parts.out()));
  const PetscInt* indices;
  petsc::check(ISGetIndices(parts, &indices));
  std::vector<int> result(indices, indices + mesh.positions.size());
  petsc::check(ISRestoreIndices(parts, &indices));
  return result;
}

long long edge_cut(const RawMesh& mesh, const std::vector<int>& ranks) {
  const NodeGraph graph = node_graph(mesh);
  const auto starts = starts_of(mesh.comm, static_cast<PetscInt>(mesh.positions.size()));
  const auto others = ask<int>(
      mesh.comm, graph.columns, [&](PetscInt node) { return owner_of(starts, node); },
      [&](PetscInt node) { return ranks[node - mesh.first_node]; });
  long long mine = 0, all = 0;
  for (std::size_t i = 0; i < ranks.size(); ++i)
    for (PetscInt k = graph.rows[i]; k < graph.rows[i + 1]; ++k) mine += others[k] != ranks[i];
  MPI_Allreduce(&mine, &all, 1, MPI_LONG_LONG, MPI_SUM, mesh.comm);
  return all / 2;
}

}  // namespace floe::mesh
