#pragma once
#include "floe/fem/element.h"

namespace floe::fem {

/// Dofs (displacement, right-handed rotation) of a point at `arm` from a master node, both of one rigid region, small
/// rotations:
///   u_p = u + theta x arm,  theta_p = theta;   q_p = T q
/// Forces go the other way with T'. Planar: (u, v, rotation).
Eigen::Matrix<double, 6, 6> rigid_arm(const Eigen::Vector3d& arm);
Eigen::Matrix3d rigid_arm(const Eigen::Vector2d& arm);  ///< in the plane

/// The same on a line hinge along the axis e, but for the point's own turn about it: theta_p = (1 - e e') theta.
Eigen::Matrix<double, 6, 6> line_arm(const Eigen::Vector3d& arm, const Eigen::Vector3d& axis);

/// Both nodes' arms on the diagonal: T of an element of two nodes.
Eigen::MatrixXd rigid_arms(const Eigen::Vector3d& first, const Eigen::Vector3d& second);

/// The element on other dofs, q_e = T q_m: rigid links, offsets, turned nodal axes, dofs held (columns left out).
///
/// Strains and displacements are linear in q or in slopes linear in q, so energy and mass points carry over exactly:
/// U_m(q_m) = U_e(T q_m), M_m = T'M_e T. Positions of mass points stay.
/// @param T  dofs of the element x dofs of the result
/// @throws floe::InputError  rows of T do not match the element
ElementMaps transformed(const ElementMaps& maps, const Eigen::MatrixXd& T);

/// The same for bare samples: loads on what is carried by other dofs.
std::vector<body::MassPoint> transformed(const std::vector<body::MassPoint>& points, const Eigen::MatrixXd& T);

}  // namespace floe::fem
