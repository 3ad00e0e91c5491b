#include "floe/fem/element_count.h"

#include <algorithm>

namespace floe::fem {

PetscInt element_count(const Mesh& mesh) {
  if (mesh.cell_count == 0) return 0;  // which may have no communicator
  PetscInt springs = std::count_if(mesh.cells.begin(), mesh.cells.end(),
                                   [](const Mesh::Cell& cell) { return cell.kind == CellKind::spring; });
  MPI_Allreduce(MPI_IN_PLACE, &springs, 1, MPIU_INT, MPI_SUM, mesh.comm);
  return mesh.cell_count - springs;
}

}  // namespace floe::fem
