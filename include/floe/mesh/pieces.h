#pragma once
#include "floe/mesh/links.h"

namespace floe::mesh {

/// Links with pieces besides: sets of nodes that move as one rigid body each. Sets and links with a node in common are
/// one piece; it is led by the reference of its link, if it has one, else by the node in the middle of its numbers.
///
/// @param links   as mesh::followers gives them
/// @return        ascending by node
/// Rank-local.
std::vector<Follower> with_pieces(const std::vector<Follower>& links, const std::vector<std::vector<PetscInt>>& pieces);

}  // namespace floe::mesh
