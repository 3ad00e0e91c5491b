#pragma once
#include <array>

#include "floe/fem/element.h"
#include "floe/fem/shell_section.h"

/// Flat thin shells: nodes of six dofs (u, v, w, rotation vector), displacements and right-handed rotations both in
/// body axes, d = 3. Normals follow the order of the nodes (right hand); in an element's own axes (x along the
/// section's axis, z along the normal) rotation_x = w_y and rotation_y = -w_x.
namespace floe::fem {

using TriangleNodes = std::array<Eigen::Vector3d, 3>;       ///< positions in body axes [m]
using QuadrilateralNodes = std::array<Eigen::Vector3d, 4>;  ///< around the element, convex; may be warped

/// StrainPoint of a triangle in fixed size, eps = L q + 1/2 sum_c (c_x^2, c_y^2, 2 c_x c_y), with the rows c_x, c_y of
/// G q for each component c of the displacement that the strain has: w, normal to the element (von Karman), or all
/// three in body axes (Green-Lagrange: the sum does not depend on axes, and each row has three entries whichever way
/// the element lies).
struct ShellStrain {
  double weight;      ///< area [m2]
  Eigen::Matrix3d D;  ///< A of the section [N/m]
  Eigen::Matrix<double, 3, 18> L;
  Eigen::Matrix<double, Eigen::Dynamic, 18, 0, 6, 18> G;
};

/// A sample of an element's surface at its nodes' plane: what pressures act on. Force f per area: sum area N' f.
struct SurfacePoint {
  double area;             ///< quadrature weight [m2]
  Eigen::Vector3d x;       ///< position
  Eigen::MatrixXd N;       ///< 3 x dofs, its displacement
  Eigen::Vector3d normal;  ///< unit
};

/// Thin triangle: DKT bending, OPT membrane with drilling rotations, von Karman or Green-Lagrange membrane strain
/// (ShellSection::strains).
///
///   U(q) = 1/2 a [ e' A e + mean of kappa' D* kappa ] + 3/8 beta_0 theta' K_theta theta,
///   e = L q + 1/2 (w_x^2, w_y^2, 2 w_x w_y),   L q = mean membrane strain + C corner curvature,   C = A^-1 B
///   second_order:  e = L q + 1/2 (|u_x|^2, |u_y|^2, 2 u_x.u_y),  u = (u, v, w)
///
/// The mean strain is that of the constant-strain triangle whose nodes move by u_i - alpha/2 theta_i z x (x_i -
/// centroid) (lumping, ShellSection::drilling); theta are the drilling rotations less the rotation of that triangle. e
/// is one point and its slopes are those of the plane through the displaced nodes: the membrane can balance them on any
/// mesh that follows a developable surface, so nothing locks. Drilling rotations, in e and against the drilling
/// stiffness, are relative to that plane to second order with both kinds of strains,
///
///   theta_n - (v_x - u_y) / 2 - (w_x theta_x + w_y theta_y) / 2   of log(R'exp(theta)), R the plane's rotation,
///
/// or a twist of what has rotated would lock. With all gradients of that plane a rigid rotation by any angle has no
/// membrane strain. With strains of second order rotations of nodes are rotation vectors, as those of beams, joints and
/// rigid regions: they rotate the normal n by exp(theta), so that the slopes in the bending rows are those of
/// theta + 1/2 (theta.n) theta x n, bending is a strain, too, and K_b = 0. What is left of a rigid rotation's energy is
/// of order a^6 in bending and drilling. Von Karman's have slopes instead of rotation vectors, K_b q linear. The
/// membrane force is taken as constant over the element: coupling B acts on the curvature of the corners' rotations,
/// linear in between (beta_x,x, beta_y,y, beta_x,y + beta_y,x), a field like that of the membrane, and all of DKT's
/// bends with D*. A plane at a distance c from the nodes (C = c I) is thus stretched as if rigid arms c along the
/// normal carried it, the drilling rotations relative to that plane: with DKT's mean curvature an offset locks. Exact
/// for states of constant strain and curvature with any A, B, D; a sum of squares whenever [A B; B D] is positive
/// definite.
///
/// Mass points stand at the middles of the edges, above and below the centre of mass by the radius of inertia: there
/// DKT's deflection (the edge's cubic) and rotations are known. Mass and its first and second moments are exact;
/// drilling rotations carry none.
/// @throws InputError  no area; the section's axis is normal to the element
/// Sources: Batoz, Bathe & Ho 1980; Felippa 2003, A study of optimal membrane triangles with drilling freedoms.
ElementMaps shell_triangle(const TriangleNodes& nodes, const ShellSection& section);
std::vector<SurfacePoint> shell_triangle_surface(const TriangleNodes& nodes);  ///< three

/// The same in fixed size, without allocation. K = bending + w L'DL, as ElementMaps has it.
Eigen::Matrix<double, 18, 18> shell_triangle_stiffness(const TriangleNodes& nodes, const ShellSection& section);
Eigen::Matrix<double, 18, 18> shell_triangle_bending(const TriangleNodes& nodes, const ShellSection& section);  ///< K_b
Eigen::Matrix<double, 18, 18> shell_triangle_mass(const TriangleNodes& nodes, const ShellSection& section);     ///< M
ShellStrain shell_triangle_strain(const TriangleNodes& nodes, const ShellSection& section);  ///< L, G

/// Quadrilateral: the triangles on either side of each diagonal, at half weight: the mean of two triangulated surfaces.
/// Passes the patch tests of the triangle, flat or warped (a warped element is the mean of its two folded surfaces, and
/// has the mean of their areas and masses). 24 dofs, four strain points. Corners drill about the normals N of the
/// bilinear surface there, relative to the rotation Omega of each triangle's plane, (theta - Omega).N / N.n: where a
/// warped surface bends without stretching its corners rotate about axes in it, which drill about the triangles'
/// normals n (a thin element would lock by the square of its warp over the thickness).
/// @throws InputError  as the triangle; it is not convex, or folds by a right angle or more
ElementMaps shell_quadrilateral(const QuadrilateralNodes& nodes, const ShellSection& section);
/// One of its triangles (quadrilateral_triangles), at whole weight: 18 dofs.
ElementMaps shell_quadrilateral_part(const QuadrilateralNodes& nodes, int triangle, const ShellSection& section);
std::vector<SurfacePoint> shell_quadrilateral_surface(const QuadrilateralNodes& nodes);  ///< twelve
/// K and M in fixed size, as for the triangle.
Eigen::Matrix<double, 24, 24> shell_quadrilateral_stiffness(const QuadrilateralNodes& nodes,
                                                            const ShellSection& section);
Eigen::Matrix<double, 24, 24> shell_quadrilateral_mass(const QuadrilateralNodes& nodes,
                                                       const ShellSection& section);  ///< M

/// Corners of its four triangles; each counts half.
inline constexpr std::array<std::array<int, 3>, 4> quadrilateral_triangles{
    {{0, 1, 2}, {0, 2, 3}, {0, 1, 3}, {1, 2, 3}}};

}  // namespace floe::fem
