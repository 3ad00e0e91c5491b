#pragma once
#include "floe/mesh/links.h"

namespace floe::mesh {

/// A mesh whose elements are half as long: lines become two, triangles and quadrilaterals four, of their kind and part.
/// Nodes keep their numbers; new ones follow. They lie in the middle of edges and elements, of second order on their
/// curves and surfaces, so that the refined mesh has the same geometry: flat elements remain flat.
///
/// A node on an edge belongs to a place that has both ends of it, but where the place is a line along the boundary and
/// the edge is a chord of it; a node within an element to a place that has all its corners. One between nodes of the
/// same rigid region belongs to that region.
///
/// @param whole      all of it on every rank (first_node = first_cell = 0)
/// @param links      of it; receives those of the new nodes. Ascending by node
/// @param undivided  of each part: whether its elements remain as they are. Empty: none
/// @return all of it on every rank. Rank-local.
RawMesh halved(const RawMesh& whole, std::vector<DependentNode>& links, const std::vector<char>& undivided = {});

}  // namespace floe::mesh
