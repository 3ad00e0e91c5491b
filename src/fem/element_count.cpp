#include "floe/fem/element_count.h"

#include <algorithm>

namespace floe::fem {

PetscInt element_count(const Mesh& mesh) {
  if (mesh.cell_count == 0) return 0;  // which may have no communicator
  PetscInt count = std::count_if(mesh.cells.begin(), mesh.cells.end(),
                                 [](const Mesh::Cell& cell) { return mesh::has_extent(cell.kind); });
  MPI_Allreduce(MPI_IN_PLACE, &count, 1, MPIU_INT, MPI_SUM, mesh.comm);
  return count;
}

}  // namespace floe::fem
