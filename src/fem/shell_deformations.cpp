#include "shell_triangle.h"

namespace floe::fem::shell {
namespace {

using Matrix3 = Eigen::Matrix3d;

/// Strain of a displacement whose gradient is d g': (d_x g_x, d_y g_y, d_x g_y + d_y g_x).
Eigen::Vector3d strain(const Eigen::Vector2d& d, const Eigen::Vector2d& g) {
  return {d.x() * g.x(), d.y() * g.y(), d.x() * g.y() + d.y() * g.x()};
}

/// Curvature of the corners' rotations alone, linear in between.
template <class Rows>
void add_linear_curvature(const Geometry& t, Rows&& rows) {
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector2d& g = t.gradient[i];
    rows.col(6 * i + 4) += strain({1, 0}, g);  // beta_x = rotation_y
    rows.col(6 * i + 3) -= strain({0, 1}, g);  // beta_y = -rotation_x
  }
}

/// Rotations of the normal: beta = sum L_i beta_i - sum_k 4 L_i L_j d_k a_k, with a_k from w and beta at the ends of
/// edge k = ij, d_k = x_j - x_i. Its curvature is a mean and, per a_k, a part that varies linearly about it.
/// Source: Batoz, Bathe & Ho 1980 (their mid-side rotations, written in d_k and a_k).
void bend(const Geometry& t, const Matrix3& bending, Deformations& out) {
  for (int k = 0; k < 3; ++k) add_edge_bending(out.rows.row(3 * edge_bending + k), t.edge[k], 1);
  auto mean = out.rows.middleRows<3>(3 * mean_curvature);
  Matrix3 of_edges;  // column k: mean curvature per a_k
  for (int k = 0; k < 3; ++k) of_edges.col(k) = strain(t.edge[k].along, 4.0 / 3 * t.gradient[k]);
  mean.noalias() += of_edges.lazyProduct(out.rows.middleRows<3>(3 * edge_bending));
  add_linear_curvature(t, mean);
  Matrix3& S = out.stiffness[edge_bending];  // by the middles of the edges, exact for squares of linear functions
  S.setZero();
  for (int m = 0; m < 3; ++m) {
    Matrix3 about_mean;
    for (int k = 0; k < 3; ++k) about_mean.col(k) = strain(t.edge[k].along, (m == k ? 2 : -2) * t.gradient[m]);
    about_mean -= of_edges;
    S.noalias() += about_mean.transpose().lazyProduct(bending.lazyProduct(about_mean).eval());
  }
  S /= 3;
  out.stiffness[mean_curvature] = bending;
}

/// Strain of the constant-strain triangle whose corners move by u_i - alpha/2 theta_i z x corner_i, and
/// the drilling rotations less that triangle's own.
void stretch(const Geometry& t, double alpha, Deformations& out) {
  auto mean = out.rows.middleRows<3>(3 * mean_strain);
  auto drill = out.rows.middleRows<3>(3 * drilling);
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector2d &g = t.gradient[i], &c = t.corner[i];
    mean.col(6 * i) = strain({1, 0}, g);
    mean.col(6 * i + 1) = strain({0, 1}, g);
    mean.col(6 * i + 5) = strain({alpha / 2 * c.y(), -alpha / 2 * c.x()}, g);
    drill.col(6 * i).setConstant(g.y() / 2);
    drill.col(6 * i + 1).setConstant(-g.x() / 2);
    drill(i, 6 * i + 5) = 1;
  }
}

/// Drilling about the normals of the corners.
void tilt(const Geometry& t, Deformations& out) {
  for (int i = 0; i < 3; ++i) {
    if (t.tilt[i].isZero(0)) continue;
    const Eigen::Matrix<double, 12, 1> drilled = out.rows.col(6 * i + 5);
    out.rows.col(6 * i + 3) += t.tilt[i].x() * drilled;
    out.rows.col(6 * i + 4) += t.tilt[i].y() * drilled;
    for (int j = 0; j < 3; ++j)  // the plane rotates by (w_y, -w_x)
      out.rows.col(6 * j + 2) += (t.tilt[i].y() * t.gradient[j].x() - t.tilt[i].x() * t.gradient[j].y()) * drilled;
  }
}

/// d.eps.d of the edges d = 12, 23, 31 at each corner, per drilling rotation, times 3 / (2 area): the optimal template,
/// beta_1..9 = 1, 2, 1, 0, 1, -1, -1, -1, -2. Source: Felippa 2003.
const std::array<Matrix3, 3>& natural_strains() {
  static const std::array<Matrix3, 3> corners = [] {
    std::array<Matrix3, 3> Q;
    Q[0] << 1, 2, 1, 0, 1, -1, -1, -1, -2;
    Q[1] << -2, -1, -1, 1, 1, 2, -1, 0, 1;
    Q[2] << 1, -1, 0, -1, -2, -1, 2, 1, 1;
    return Q;
  }();
  return corners;
}

/// 3/4 beta_0 K_theta per area: the strains vary linearly between the corners.
void drill(const Geometry& t, const ShellSection& section, Deformations& out) {
  Matrix3 to_strain;  // from d.eps.d of the edges d = 12, 23, 31: eps = -sum (d.eps.d) (g_i g_j' + g_j g_i') / 2
  for (int k = 0; k < 3; ++k) to_strain.col(k) = -strain(t.gradient[k], t.gradient[(k + 1) % 3]);
  const Matrix3 stiffness = to_strain.transpose().lazyProduct(section.A.lazyProduct(to_strain).eval());
  const std::array<Matrix3, 3>& Q = natural_strains();
  Matrix3& S = out.stiffness[drilling];
  S.setZero();
  for (int m = 0; m < 3; ++m) {
    const Matrix3 middle = (Q[m] + Q[(m + 1) % 3]) / 2;
    S.noalias() += middle.transpose().lazyProduct(stiffness.lazyProduct(middle).eval());
  }
  S *= 0.75 * section.higher_order * 4 * t.area * t.area / 9;
}

}  // namespace

Deformations deformations(const Geometry& geometry, const ShellSection& section) {
  Deformations out;
  out.rows.setZero();
  stretch(geometry, section.drilling, out);
  bend(geometry, section.bending, out);
  drill(geometry, section, out);
  out.stiffness[mean_strain] = section.A;
  // eps + C kappa with the curvature of a field like that of eps: a plane at a distance c, C = c I, is then stretched
  // by the corners' u + c beta alone. The bending of the edges is of higher degree, and nothing in eps could cancel it.
  // The drilling rotations are relative to that plane, too.
  Rows18 linear = Rows18::Zero();
  add_linear_curvature(geometry, linear);
  out.rows.middleRows<3>(3 * mean_strain).noalias() += section.coupling.lazyProduct(linear);
  const double height = (section.coupling(0, 0) + section.coupling(1, 1)) / 2;
  auto drill = out.rows.middleRows<3>(3 * drilling);
  for (int i = 0; i < 3; ++i) {
    drill.col(6 * i + 4).array() += height / 2 * geometry.gradient[i].y();
    drill.col(6 * i + 3).array() += height / 2 * geometry.gradient[i].x();
  }
  tilt(geometry, out);
  to_body_axes(out.rows, geometry.axes);
  return out;
}

}  // namespace floe::fem::shell
