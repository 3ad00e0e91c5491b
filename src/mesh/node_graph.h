#pragma once
#include "floe/mesh/raw_mesh.h"

namespace floe::mesh {

/// Of each node of the share the nodes that share a cell with it, ascending, in compressed rows.
struct NodeGraph {
  std::vector<PetscInt> rows{0}, columns;
};

/// Collective.
NodeGraph node_graph(const RawMesh& mesh);

}  // namespace floe::mesh
