#include <metis.h>
#include <petsc/private/matimpl.h>

#include <limits>

#include "floe/mesh/partition.h"
#include "floe/petsc/handle.h"

namespace floe::mesh {
namespace {

/// Numbers of METIS' width, which need not be PETSc's. @throws RunError  one does not fit
std::vector<idx_t> of_metis(const PetscInt* values, PetscInt count) {
  for (PetscInt i = 0; i < count; ++i)
    if (values[i] > std::numeric_limits<idx_t>::max())
      throw RunError("the mesh's graph is too large for METIS; use -mesh_mat_partitioning_type ptscotch");
  return {values, values + count};
}

// Fills the part of every row; returns the status of METIS.
int metis_parts(Mat whole, PetscInt parts, std::vector<PetscInt>& part) {
  PetscInt rows = 0;
  const PetscInt *starts = nullptr, *columns = nullptr;
  PetscBool done = PETSC_FALSE;
  petsc::check(MatGetRowIJ(whole, 0, PETSC_FALSE, PETSC_FALSE, &rows, &starts, &columns, &done));
  if (!done) throw RunError("the rows of the mesh's graph cannot be read");
  part.resize(rows);
  int status = METIS_OK;
  if (rows <= parts) {  // METIS may leave parts empty, or fail
    for (PetscInt i = 0; i < rows; ++i) part[i] = i;
  } else {
    std::vector<idx_t> begins = of_metis(starts, rows + 1), neighbours = of_metis(columns, starts[rows]), found(rows);
    idx_t options[METIS_NOPTIONS], constraints = 1, cut = 0, vertices = static_cast<idx_t>(rows),
                                   wanted = static_cast<idx_t>(parts);
    METIS_SetDefaultOptions(options);
    options[METIS_OPTION_SEED] = 0;  // the same parts in every run
    status = METIS_PartGraphKway(&vertices, &constraints, begins.data(), neighbours.data(), nullptr, nullptr, nullptr,
                                 &wanted, nullptr, nullptr, options, &cut, found.data());
    part.assign(found.begin(), found.end());
  }
  petsc::check(MatRestoreRowIJ(whole, 0, PETSC_FALSE, PETSC_FALSE, &rows, &starts, &columns, &done));
  return status;
}

// Collective on the partitioning's ranks.
void apply(MatPartitioning partitioning, IS* result) {
  const MPI_Comm comm = PetscObjectComm(reinterpret_cast<PetscObject>(partitioning));
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  petsc::MatHandle whole;
  petsc::check(MatMPIAdjToSeqRankZero(partitioning->adj, whole.out()));
  std::vector<PetscInt> all;
  petsc::agree(comm, [&] {
    if (rank != 0) return;
    const int status = metis_parts(whole, partitioning->n, all);
    if (status != METIS_OK) throw RunError("METIS could not partition the mesh (code " + std::to_string(status) + ")");
  });
  PetscInt rows = 0;
  petsc::check(MatGetLocalSize(partitioning->adj, &rows, nullptr));
  const auto starts = starts_of(comm, rows);
  std::vector<int> counts, displacements(starts.begin(), starts.end() - 1);
  for (std::size_t r = 0; r + 1 < starts.size(); ++r) counts.push_back(starts[r + 1] - starts[r]);
  std::vector<PetscInt> mine(rows);
  MPI_Scatterv(all.data(), counts.data(), displacements.data(), MPIU_INT, mine.data(), rows, MPIU_INT, 0, comm);
  petsc::check(ISCreateGeneral(comm, rows, mine.data(), PETSC_COPY_VALUES, result));
}

PetscErrorCode apply_callback(MatPartitioning partitioning, IS* result) {
  try {
    apply(partitioning, result);
    return 0;
  } catch (const std::exception& error) {
    return PetscError(PETSC_COMM_SELF, __LINE__, "MatPartitioningApply_Metis", __FILE__, PETSC_ERR_LIB,
                      PETSC_ERROR_INITIAL, "%s", error.what());
  }
}

PetscErrorCode create(MatPartitioning partitioning) {
  partitioning->ops->apply = apply_callback;
  return 0;
}

}  // namespace

void register_metis() {
  static bool registered = false;
  if (!registered) petsc::check(MatPartitioningRegister("metis", create));
  registered = true;
}

}  // namespace floe::mesh
