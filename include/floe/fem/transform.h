#pragma once
#include "floe/fem/element.h"
#include "floe/fem/mesh.h"

namespace floe::fem {

/// Dofs (displacement, right-handed rotation) of a point at `arm` from a master node, both of one rigid region, small
/// rotations:
///   u_p = u + theta x arm,  theta_p = theta;   q_p = T q
/// Forces go the other way with T'. Planar: (u, v, rotation).
Eigen::Matrix<double, 6, 6> rigid_arm(const Eigen::Vector3d& arm);
Eigen::Matrix3d rigid_arm(const Eigen::Vector2d& arm);  ///< in the plane

/// The same but for the point's own rotations, of orthonormal directions S: theta_p = (1 - S S') theta.
Eigen::Matrix<double, 6, 6> spin_arm(const Eigen::Vector3d& arm, const Eigen::Matrix3d& S);

/// Both nodes' arms on the diagonal: T of an element of two nodes.
Eigen::MatrixXd rigid_arms(const Eigen::Vector3d& first, const Eigen::Vector3d& second);

/// A point at `arm` from the node that it follows, as it moves to second order:
///   u_p = u + theta x arm + 1/2 theta x (theta x arm)
/// Without the last term a rigid region that rotates by theta grows by theta^2/2, and strains what it is joined to.
struct RigidArm {
  Eigen::Index point;     ///< of u_p: the first of the d dofs of the element
  Eigen::Index rotation;  ///< of theta: the first of the three dofs (one in the plane) of the result
  Eigen::Vector3d arm;
};

/// The corners of a cell that follow others at an arm: dofs of its corners, and of the nodes that it acts on.
std::vector<RigidArm> rigid_arms(const Mesh& mesh, const Mesh::Cell& cell);

/// The element on other dofs, q_e = T q_m: rigid links, offsets, rotated nodal axes, dofs constrained (columns left
/// out).
///
/// Strains and displacements are linear in q or in slopes linear in q, so energy and mass points carry over exactly:
/// U_m(q_m) = U_e(T q_m), M_m = T'M_e T. Positions of mass points stay.
/// @param T     dofs of the element x dofs of the result
/// @param arms      what moves by second-order terms besides, q_e = T q_m + 1/2 R(q_m, q_m): inertia takes them to
/// second
///                  order (rotary)
/// @param strained  strain points, too: eps = L T q + 1/2 [L R(q, q) + e(T q, T q)]; K_b does not
/// @throws floe::InputError  rows of T do not match the element
ElementMaps transformed(const ElementMaps& maps, const Eigen::MatrixXd& T, const std::vector<RigidArm>& arms = {},
                        bool strained = true);

/// The same for bare samples: loads on what is carried by other dofs.
std::vector<body::MassPoint> transformed(const std::vector<body::MassPoint>& points, const Eigen::MatrixXd& T);

}  // namespace floe::fem
