#pragma once
#include "floe/fem/mesh.h"

namespace floe::fem {

/// Sets Mesh::Cell::rise of shells with three and four nodes. The surface has at each node the normal N that the elements
/// there have on average, by their angles; a corner at r from the element's middle, where its own normal is n (of the two
/// edges: warped quadrilaterals follow the surface), has the height |r| |n x N| / 2 of a sphere, and the rise is the mean
/// of the corners. Corners where the surface is folded or branches, by 42 degrees or more between two halves, have none: a
/// box is flat plates, a tube of nine elements around a curve. Collective.
void set_rises(Mesh& mesh);

}  // namespace floe::fem
