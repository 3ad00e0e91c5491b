#pragma once
#include "floe/fem/element.h"

namespace floe::fem {

/// A linear spring between two nodes of one body, without mass: six stiffnesses along and about its own axes, on the
/// motion of the second node relative to the first, both carried rigidly to one point p of the line between them.
///
///   2 U = sum_i k_i (e_i . du)^2 + sum_i k_(3+i) (e_i . dtheta)^2
///   du = u_2 + theta_2 x (p - x_2) - u_1 - theta_1 x (p - x_1),   dtheta = theta_2 - theta_1
///
/// du and dtheta vanish in every rigid motion, wherever the nodes are.
struct NodeSpring {
  Eigen::Matrix<double, 6, 1> stiffness;  ///< three along [N/m], three about the axes [N m], none negative
  Eigen::Matrix3d axes;                   ///< columns e_i, in body axes
  double at = 0.5;                        ///< p = x_1 + at (x_2 - x_1)
};

/// @throws floe::InputError  a stiffness that is negative or not finite, axes that are no rotation
ElementMaps node_spring(const Eigen::Vector3d& first, const Eigen::Vector3d& second, const NodeSpring& spring);

}  // namespace floe::fem
