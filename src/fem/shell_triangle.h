#pragma once
#include "floe/fem/shell.h"

namespace floe::fem::shell {

using Row18 = Eigen::Matrix<double, 1, 18>;
using Rows18 = Eigen::Matrix<double, 3, 18>;

/// From one corner to the next, in the element's axes.
struct Edge {
  int from, to;
  Eigen::Vector2d along;  ///< [m]
  double factor;          ///< 3 / (2 length^2)
};

/// Of a surface at the corners, of any length; zero: of the triangle.
using Normals = std::array<Eigen::Vector3d, 3>;

struct Geometry {
  double area;
  Eigen::Matrix3d axes;                     ///< columns x, y, z in body axes
  std::array<Eigen::Vector2d, 3> corner;    ///< from the centroid, in the element's axes
  std::array<Eigen::Vector2d, 3> gradient;  ///< of the corner's area coordinate [1/m]
  std::array<Edge, 3> edge;                 ///< edge k is opposite to corner k
  std::array<Eigen::Vector2d, 3> tilt{Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero(),
                                      Eigen::Vector2d::Zero()};  ///< of the corner's normal: (x, y) / z
};

Geometry geometry(const TriangleNodes& nodes, const Eigen::Vector3d& axis);
/// Of a triangle in a surface that is not flat. Corners drill about the surface's normals N there, relative to the
/// rotation Omega of the triangle's plane, (theta - Omega).N / N.n, except where N is 60 degrees or more from n: where
/// the surface bends without stretching they rotate about axes in it, which about the triangle's normal would be
/// drilling, and would lock.
Geometry geometry(const TriangleNodes& nodes, const Eigen::Vector3d& axis, const Normals& normals);
/// Of a quadrilateral at the corners of one of its triangles (quadrilateral_triangles): of the edges that meet there;
/// zero where the quadrilateral is all but flat.
Normals corner_normals(const QuadrilateralNodes& nodes, int triangle);

/// Four triples of an element's deformations, each with its stiffness per area: U = 1/2 area sum R'SR. Together they
/// and the rigid motions span the 18 dofs.
enum Deformation { mean_strain, mean_curvature, edge_bending, drilling };
struct Deformations {
  Eigen::Matrix<double, 12, 18> rows;  ///< three for each, on the dofs in body axes
  std::array<Eigen::Matrix3d, 4> stiffness;
};

Deformations deformations(const Geometry& geometry, const ShellSection& section);

/// What shell_triangle_stiffness, shell_triangle_strain and shell_triangle give.
Eigen::Matrix<double, 18, 18> triangle_stiffness(const Geometry& geometry, const ShellSection& section);
ShellStrain triangle_strain(const Geometry& geometry, const ShellSection& section);
ElementMaps triangle_maps(const Geometry& geometry, const TriangleNodes& nodes, const ShellSection& section);

/// Rows of ShellStrain::G: c_x, c_y of each component c.
inline int gradient_rows(const ShellSection& section) { return section.strains == Strains::second_order ? 6 : 2; }

/// Adds the gradients of the plane through the displaced nodes to rows of zeros, gradient_rows x 18.
template <class Rows>
void set_gradients(const Geometry& geometry, const ShellSection& section, Rows& G) {
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector2d& gradient = geometry.gradient[i];
    if (section.strains == Strains::von_karman)
      G.template middleCols<3>(6 * i).noalias() = gradient * geometry.axes.col(2).transpose();
    else
      for (int c = 0; c < 3; ++c) G(2 * c, 6 * i + c) = gradient.x(), G(2 * c + 1, 6 * i + c) = gradient.y();
  }
}

/// Adds what rotations of the corners do at second order to strains whose rows L are linear in them. In the element's
/// axes, with the slopes w_x and w_y of the plane through the displaced nodes:
///
///   slopes of the surface     theta + 1/2 (theta.n) theta x n, as exp(theta) rotates n (strains of second order)
///   drilling of the corner    theta_n - 1/2 (w_x theta_x + w_y theta_y), relative to the plane
///
/// The second is the normal component of log(R'exp(theta)) with the rotation R of the plane. Without it the drilling
/// stiffness resists the twist of a surface that has rotated.
/// @param L    three rows on the dofs in body axes
/// @param G    receives the rows of the slopes, unless it begins with them (von Karman's membrane), and of theta
/// @param add  (p, q, C): C a_p a_q of each strain, a = G q, p < q
template <class Rows, class Gradients, class Add>
void add_rotations(const Geometry& geometry, Strains strains, const Rows& L, Gradients& G, Add&& add) {
  constexpr double round_off = 1e-12;
  std::array<Eigen::Matrix3d, 3> by_theta;  // of each corner: its coefficients in each strain, in the element's axes
  bool normals = false, drills = false;
  for (int i = 0; i < 3; ++i) {
    by_theta[i] = L.template middleCols<3>(6 * i + 3) * geometry.axes;
    for (int r = 0; r < 3; ++r) {
      auto c = by_theta[i].row(r);
      const double least = round_off * c.norm();
      if (strains == Strains::von_karman || c.template head<2>().norm() < least) c.template head<2>().setZero();
      if (std::abs(c[2]) < least) c[2] = 0;
    }
    normals = normals || !by_theta[i].leftCols<2>().isZero(0);
    drills = drills || !by_theta[i].col(2).isZero(0);
  }
  if (!normals && !drills) return;
  const bool sloped = strains == Strains::von_karman && G.rows() > 0;
  const int before = static_cast<int>(G.rows()), slope = sloped ? 0 : before,
            first = before + (drills && !sloped ? 2 : 0), each = normals ? 3 : 2;
  G.conservativeResize(first + 3 * each, 18);
  G.bottomRows(first - before + 3 * each).setZero();
  for (int i = 0; i < 3; ++i) {
    const int x = first + each * i, y = x + 1, n = x + 2;
    if (first > before) G.template block<2, 3>(slope, 6 * i) = geometry.gradient[i] * geometry.axes.col(2).transpose();
    G.block(x, 6 * i + 3, each, 3) = geometry.axes.leftCols(each).transpose();
    const Eigen::Matrix3d c = by_theta[i] / 2;
    if (normals) add(x, n, Eigen::Vector3d(-c.col(1))), add(y, n, Eigen::Vector3d(c.col(0)));
    if (drills) add(slope, x, Eigen::Vector3d(-c.col(2))), add(slope + 1, y, Eigen::Vector3d(-c.col(2)));
  }
}

/// Adds the coefficients of the normal's rotation, beta = (rotation_y, -rotation_x), of a corner to a row.
template <class Row>
void add_beta(Row&& row, int corner, const Eigen::Vector2d& coefficients) {
  row[6 * corner + 3] -= coefficients.y();
  row[6 * corner + 4] += coefficients.x();
}

/// Adds `times` the bending of an edge, a = 3/2 [(w_j - w_i) + d.(beta_i + beta_j) / 2] / l^2, d from i to j, l = |d|:
/// the cubic of the edge has the slope -d.beta / l at its middle, beta = (beta_i + beta_j) / 2 - d a.
template <class Row>
void add_edge_bending(Row&& row, const Edge& edge, double times) {
  row[6 * edge.from + 2] -= times * edge.factor;
  row[6 * edge.to + 2] += times * edge.factor;
  const Eigen::Vector2d half = times * edge.factor / 2 * edge.along;
  add_beta(row, edge.from, half);
  add_beta(row, edge.to, half);
}

/// Rows on dofs in the element's axes -> on dofs in body axes.
template <class Rows>
void to_body_axes(Rows& rows, const Eigen::Matrix3d& axes) {
  const Eigen::Matrix3d rotation = axes.transpose();
  for (int block = 0; block < 6; ++block) {
    auto columns = rows.template middleCols<3>(3 * block);
    columns = columns.lazyProduct(rotation).eval();
  }
}

/// Motion at the middle of an edge: (u, v, w) of the plane of the nodes and beta, in the element's axes, on the dofs in
/// body axes. w is the cubic of the edge; beta is linear across it and follows the cubic's slope along it.
struct Middle {
  Eigen::Vector2d at;                 ///< from the centroid
  Eigen::Matrix<double, 5, 18> rows;  ///< u, v, w, beta_x, beta_y
  Eigen::Matrix<double, 2, 18> arms;  ///< mean beta_x, beta_y of the ends: they move a plane at an offset
};
Middle middle(const Geometry& geometry, int edge);

}  // namespace floe::fem::shell
