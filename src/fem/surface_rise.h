#pragma once
#include "floe/fem/mesh.h"

namespace floe::fem {

/// Sets Mesh::Cell::rise of shells with three and four nodes, a length by which the surface is not the element:
///
///   s = mean over the corners of |r| |n x N| / 2
///
/// r from the element's middle, n the element's normal at the corner (of the two edges: warped quadrilaterals follow
/// the surface), N that of the surface there, the mean of the elements at the node by their angles. For squares of side
/// h on a sphere of curvature k it is their height k h^2 / 4, for rectangles h by l on a cylinder k h (h^2 +
/// l^2)^(1/2) / 8. Corners where an element is 21 degrees or more from N have none: there the surface is folded, by 42
/// degrees between equal halves, or branches; nor have sharp edges (mesh::is_sharp). At free edges, at cuts into pieces
/// and at seams of linked nodes, N is that of one side. Collective.
void set_rises(Mesh& mesh);

}  // namespace floe::fem
