#pragma once
#include <span>

#include "floe/fem/shell.h"

/// Shells of second order: six nodes of a triangle, eight of a quadrilateral, corners first and then the middles of the
/// edges from each corner to the next. Edges and surface are curved where the middle nodes lie off the chords.
namespace floe::fem {

using ShellNodes = std::span<const Eigen::Vector3d>;  ///< positions in body axes [m], six or eight

/// Reissner-Mindlin shell: the nodes' displacements u_i and directors n_i, which exp(theta_i) rotates, interpolated by
/// the shape functions N_i of the surface X = sum N_i X_i, D = sum N_i n_i, n_i the normal of the element at the node:
///
///   u = sum N_i u_i,   d = sum N_i (theta_i x n_i + 1/2 theta_i x (theta_i x n_i))
///   eps_ab   = 1/2 (X_a.u_b + X_b.u_a + u_a.u_b)
///   kappa_ab = 1/2 (X_a.d_b + X_b.d_a + D_a.u_b + D_b.u_a + v_a.d_b + v_b.d_a)
///   gamma_a  = X_a.d + D.u_a + v_a.d + 1/3 (u_a - v_a).d
///   2 U = int (eps + C kappa)' A (eps + C kappa) + kappa' D* kappa + S |gamma|^2,   to second order in each strain
///
/// which a rigid rotation by a leaves zero but for terms of order a^3. v_a = n (n.u_a) + w n x X_a, w the rotation
/// about the normal n: what is left of u_a is of second order where the surface does not stretch, and its factors, 0
/// and 1/3, are such that strains at a rotation about one axis are exact to the third order, too. Von Karman's keep of
/// these (n.u_a)(n.u_b) / 2 in eps alone. eps and kappa are taken at 2 x 2 points of a quadrilateral and at three of a
/// triangle, where the in-plane displacements can balance what bending stretches: nothing locks in membrane. gamma is
/// interpolated from its components along the edges, at two Gauss points of each, by the gradients of the shape
/// functions and the constants and linear functions besides: deflections can follow every rotation of the edges, and
/// nothing locks in shear. The quadrilateral has one mode in the plane and one in bending that cost no energy; no two
/// elements that share an edge have them together.
///
/// The rotation about the normal at a node is constrained to that of the surface there, w = n.theta - 1/2 n.curl u, by
/// 1/2 drilling_share G h (area / nodes) w^2: it carries no mass and little force.
///
/// Mass points: 3 x 3 Gauss points, or six of a triangle, each above and below the centre of mass by the radius of
/// inertia.
/// @throws InputError  no area, or folded at a corner or a point; the section's axis is normal to the element
/// Sources: Ahmad, Irons & Zienkiewicz 1970; Zienkiewicz, Taylor & Too 1971 (reduced integration); Brezzi, Bathe &
/// Fortin 1989 and Bathe & Dvorkin 1986 (shear from the edges).
ElementMaps quadratic_shell(ShellNodes nodes, const ShellSection& section);

inline constexpr double drilling_share = 1e-3;

/// The points of `quadratic_shell` that are of the membrane; they come first.
constexpr std::size_t quadratic_membrane_points(std::size_t nodes) { return nodes == 6 ? 3 : 4; }

/// Samples of the surface at the mass points; `tilt` is the change of the area vector over the area.
struct CurvedPoint {
  SurfacePoint at;
  Eigen::MatrixXd tilt;  ///< 3 x dofs
};
std::vector<CurvedPoint> quadratic_shell_surface(ShellNodes nodes);

/// Part of the element's area that is nearest to a node, in the element's own coordinates: what lumps go with it.
struct NodeShare {
  double area = 0;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< of that part
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< mean, unit
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();  ///< int (x - centre)(x - centre)' over it [m4]
};
std::vector<NodeShare> quadratic_shell_shares(ShellNodes nodes);

/// Two directions in the surface and its normal at each node, columns.
std::vector<Eigen::Matrix3d> surface_axes(ShellNodes nodes);

}  // namespace floe::fem
