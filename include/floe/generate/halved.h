#pragma once
#include "floe/generate/generate.h"
#include "floe/mesh/links.h"

namespace floe::generate {

/// Which elements of a part are divided.
enum class Halved : char { all, along_shells, none };

/// A mesh whose elements are half as long: lines become two, triangles and quadrilaterals four, of their kind and part.
/// Nodes keep their numbers; new ones follow. They lie in the middle of edges and elements, of second order on their
/// curves and surfaces. Those of flat shells lie on the surface that these form: on arcs through the ends of an edge
/// by the elements' mean normals there, or by the neighbours along a rim, as flat as walls beside them (CurvedEdges);
/// folds of 42 degrees or more remain. The middle of a quadrilateral is half the sum of its arcs' middles less a
/// quarter of the corners'.
///
/// A node on an edge belongs to a place that has both ends of it, but where the place is a line along the boundary and
/// the edge is a chord of it; a node within an element to a place that has all its corners. One between nodes of the
/// same rigid region belongs to that region; one between nodes that each follow a node of their own (offset beams,
/// seams) follows the node between these, on the nearest edge of both.
///
/// @param whole  all of it on every rank (first_node = first_cell = 0)
/// @param links  of it; receives those of the new nodes. Ascending by node
/// @param parts  which elements of each part are divided. Empty: all
/// @return all of it on every rank. Rank-local.
RawMesh halved(const RawMesh& whole, std::vector<DependentNode>& links, const std::vector<Halved>& parts = {});

}  // namespace floe::generate
