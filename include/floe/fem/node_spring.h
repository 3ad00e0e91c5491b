#pragma once
#include "floe/fem/element.h"
#include "floe/mesh/deck.h"

namespace floe::fem {

/// A linear spring between two nodes of one body, without mass: six stiffnesses along and about its own axes, on the
/// motion of the second node relative to the first, both carried rigidly to one point p of the line between them.
///
///   2 U = sum_i k_i u_i^2 + sum_i k_(3+i) rho_i^2
///   bushing   u = e_i . (d + [theta_2 x (theta_2 x r_2) - theta_1 x (theta_1 x r_1)]/2 - theta_1 x d),  r_i = p - x_i,
///             d = u_2 + theta_2 x r_2 - u_1 - theta_1 x r_1,
///             rho_i = e_i . (theta_2 - theta_1 - theta_1 x theta_2/2)
///   line      u_1 = e_1 . du + |du - e_1 (e_1 . du)|^2 / (2 |x_2 - x_1|),   du = u_2 - u_1;  no other stiffness
///   linear    u_i = e_i . d,   rho_i = e_i . (theta_2 - theta_1)
///
/// The first two are the second order of a spring whose axes rotate with the first node (dynamics::SpatialBushing), and
/// of the change of length; they vanish to second order in every rigid motion, wherever the nodes are.
struct NodeSpring {
  Eigen::Matrix<double, 6, 1> stiffness;  ///< three along [N/m], three about the axes [N m], none negative
  Eigen::Matrix3d axes;                   ///< columns e_i, in body axes; of a line e_1 is its direction
  double at = 0.5;                        ///< p = x_1 + at (x_2 - x_1)
  mesh::SpringKind kind = mesh::SpringKind::bushing;
};

/// @throws floe::InputError  a stiffness that is negative or not finite, axes that are no rotation, a line without
///                           length
ElementMaps node_spring(const Eigen::Vector3d& first, const Eigen::Vector3d& second, const NodeSpring& spring);

}  // namespace floe::fem
