#pragma once
#include <vector>

#include "floe/fem/mesh.h"

namespace floe::fem {

/// Upper half of the node graph (row <= column), counted for the rows of this rank, as MATSBAIJ preallocates.
struct NodeGraph {
  std::vector<PetscInt> own;    ///< of each row, columns of this rank
  std::vector<PetscInt> other;  ///< of each row, columns of others
};

/// Exact: cells of other ranks that touch this rank's rows are sent by their owners. Collective.
NodeGraph node_graph(const Mesh& mesh);

}  // namespace floe::fem
