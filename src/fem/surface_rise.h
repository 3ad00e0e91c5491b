#pragma once
#include "floe/fem/mesh.h"

namespace floe::fem {

/// Sets Mesh::Cell::rise of shells with three and four nodes, a length by which the surface is not the element:
///
///   s = mean over the corners of |r| |n x N| / 2
///
/// r from the element's middle, n the element's normal at the corner (of the two edges: warped quadrilaterals follow
/// the surface), N that of the surface there, the mean of the elements at the node by their angles. On a square of a
/// sphere s is its height over the element; on a cylinder of curvature k, elements h by l, about k h l / 8. Corners
/// where the surface is folded or branches have none: folds of 42 degrees or more between two halves, the edge of a web
/// on a skin. At free edges, and where a mesh is cut into pieces, N is that of one side. Collective.
void set_rises(Mesh& mesh);

}  // namespace floe::fem
