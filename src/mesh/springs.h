#pragma once
#include "floe/mesh/deck.h"

namespace floe::mesh {

/// A direction and two normal to it, as columns.
Eigen::Matrix3d axes_along(const Eigen::Vector3d& first);

/// A spring of the length between two nodes. @param along  from the first to the second, not zero
NodeSpring line_spring(const Eigen::Vector3d& along, double stiffness, long long label);

}  // namespace floe::mesh
