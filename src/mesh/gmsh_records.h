#pragma once
#include "file_mesh.h"
#include "gmsh_parts.h"

namespace floe::mesh {

/// Reads the nodes first..first + count - 1 of the file into `mesh`. Rank-local.
void read_nodes(const GmshStructure& structure, Share share, FileMesh& mesh, Faults& faults);

/// Reads this rank's share of the cells and of the places' nodes into `mesh`. Rank-local.
void read_elements(const GmshStructure& structure, const GmshSelection& selection, int rank, int ranks, FileMesh& mesh,
                   Faults& faults);

}  // namespace floe::mesh
