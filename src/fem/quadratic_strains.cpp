#include "quadratic_strains.h"

#include <algorithm>
#include <cmath>

#include "floe/error.h"

namespace floe::fem::quadratic {

Surface surface_at(const Shape& shape, ShellNodes nodes, const Point& point) {
  Surface at{shape.values(point), shape.gradients(point), Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero(), {}};
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const auto k = static_cast<Index>(i);
    at.at += at.N[k] * nodes[i], at.r += at.dN(0, k) * nodes[i], at.s += at.dN(1, k) * nodes[i];
  }
  at.normal = at.r.cross(at.s);
  return at;
}

std::vector<Vector3d> directors(const Shape& shape, ShellNodes nodes) {
  std::vector<Vector3d> normals;
  Vector3d mean = Vector3d::Zero();
  for (const Point& node : shape.nodes) {
    const Surface at = surface_at(shape, nodes, node);
    if (!(at.normal.norm() > 1e-12 * std::max(at.r.squaredNorm(), at.s.squaredNorm())))
      throw InputError("a shell element has no area at a node");
    normals.push_back(at.normal.normalized()), mean += normals.back();
  }
  for (const Vector3d& normal : normals)
    if (!(normal.dot(mean) > 0)) throw InputError("a shell element of second order is folded");
  return normals;
}

LocalAxes axes_at(const Surface& at, const Vector3d& axis) {
  const Vector3d z = at.normal.normalized(), wanted = axis.isZero(0) ? at.r : axis, along = wanted - z.dot(wanted) * z;
  if (!(along.norm() > 1e-6 * wanted.norm())) throw InputError("the axis of a shell's section is normal to an element");
  LocalAxes axes;
  axes.x = along.normalized(), axes.y = z.cross(axes.x);
  Matrix2d J;
  J << at.r.dot(axes.x), at.r.dot(axes.y), at.s.dot(axes.x), at.s.dot(axes.y);
  axes.from_covariant = J.inverse();
  axes.dN = axes.from_covariant * at.dN;
  return axes;
}

namespace {

void multiply(MatrixXd& P, Index a, Index b, double c = 1) { P(a, b) += c, P(b, a) += c; }

}  // namespace

Strains3 membrane(const Element& e, const Surface& at, const LocalAxes& axes) {
  Strains3 strain = e.empty(3, e.second_order ? 6 : 2);
  const VectorXd f_x = axes.dN.row(0), f_y = axes.dN.row(1);
  e.add_displacement(strain.L.row(0), axes.x, f_x);
  e.add_displacement(strain.L.row(1), axes.y, f_y);
  e.add_displacement(strain.L.row(2), axes.x, f_y);
  e.add_displacement(strain.L.row(2), axes.y, f_x);
  if (e.second_order) {
    e.set_displacements(strain.G, 0, 2, f_x);
    e.set_displacements(strain.G, 1, 2, f_y);
  } else {
    e.add_displacement(strain.G.row(0), at.normal.normalized(), f_x);
    e.add_displacement(strain.G.row(1), at.normal.normalized(), f_y);
  }
  for (Index c = 0; c < strain.G.rows(); c += 2)
    strain.P[0](c, c) = strain.P[1](c + 1, c + 1) = 1, multiply(strain.P[2], c, c + 1);
  return strain;
}

TiedMembrane::TiedMembrane(const Element& e) : axis(e.section.axis) {
  if (axis.isZero(0)) axis = surface_at(e.shape, e.nodes, e.shape.ties.back().at[0]).r;
  for (Index k = 0; k < 9; ++k) {
    const quadratic::Tie& tie = e.shape.membrane[static_cast<std::size_t>(k)];
    const Surface at = surface_at(e.shape, e.nodes, tie.at[0]);
    const LocalAxes axes = axes_at(at, axis);
    const Vector3d t = (tie.along.x() * at.r + tie.along.y() * at.s).normalized();
    const double x = axes.x.dot(t), y = axes.y.dot(t);
    from_ties.row(k) << x * x, y * y, x * y, tie.at[0].x() * Eigen::RowVector3d(x * x, y * y, x * y),
        tie.at[0].y() * Eigen::RowVector3d(x * x, y * y, x * y);
  }
  from_ties = Eigen::MatrixXd(from_ties).inverse();
}

Strains3 tied_membrane(const Element& e, const Eigen::Matrix<double, 3, 9>& T) {
  const auto ties = static_cast<Index>(e.shape.membrane.size());
  const double unit = std::sqrt(4.5);
  Strains3 strain = e.empty(3, (e.second_order ? 3 : 1) * ties);
  for (Index k = 0; k < ties; ++k) {
    const quadratic::Tie& tie = e.shape.membrane[static_cast<std::size_t>(k)];
    const Surface at = surface_at(e.shape, e.nodes, tie.at[0]);
    const Vector3d X = tie.along.x() * at.r + tie.along.y() * at.s;
    const VectorXd f = at.dN.transpose() * tie.along / X.norm();
    Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(e.dofs());
    e.add_displacement(row, X.normalized(), f);
    strain.L += T.col(k) * row;
    if (e.second_order)
      e.set_displacements(strain.G, k, ties, f / unit);
    else
      e.add_displacement(strain.G.row(k), at.normal.normalized(), f / unit);
    for (Index c = k; c < strain.G.rows(); c += ties)
      for (Index s = 0; s < 3; ++s) strain.P[static_cast<std::size_t>(s)](c, c) = T(s, k) * unit * unit;
  }
  return strain;
}

Strains3 curvature(const Element& e, const Surface& at, const LocalAxes& axes) {
  constexpr Index spin = 2, of_director = 3, of_rotation = 9;
  Strains3 strain = e.empty(3, e.second_order ? of_rotation + 3 * e.count() : 0);
  const std::array<VectorXd, 2> f{axes.dN.row(0), axes.dN.row(1)};
  const std::array<Vector3d, 2> X{axes.x, axes.y};
  const Vector3d n = at.normal.normalized();
  std::array<Vector3d, 2> D{Vector3d::Zero(), Vector3d::Zero()};
  for (std::size_t i = 0; i < e.director.size(); ++i)
    for (int a : {0, 1}) D[a] += f[a][static_cast<Index>(i)] * e.director[i];
  const auto add = [&](Index s, int a, int b) {  // X_a.d_b + D_b.u_a + (n.u_a) (n.d_b) + w (n x X_a).d_b
    e.add_director(strain.L.row(s), X[a], f[b]);
    e.add_displacement(strain.L.row(s), D[b], f[a]);
    if (!e.second_order) return;
    const Index d = of_director + 3 * b;
    multiply(strain.P[s], a, d);
    multiply(strain.P[s], spin, a == 0 ? d + 2 : d + 1, a == 0 ? 1 : -1);
    e.add_rotations(strain.P[s], of_rotation, X[a], f[b]);
  };
  add(0, 0, 0), add(1, 1, 1), add(2, 0, 1), add(2, 1, 0);
  if (!e.second_order) return strain;
  e.add_displacement(strain.G.row(spin), axes.y / 2, f[0]), e.add_displacement(strain.G.row(spin), -axes.x / 2, f[1]);
  for (int a : {0, 1}) {
    e.add_displacement(strain.G.row(a), n, f[a]);
    e.add_director(strain.G.row(of_director + 3 * a), n, f[a]);
    for (int c : {0, 1}) e.add_director(strain.G.row(of_director + 3 * a + 1 + c), X[c], f[a]);
  }
  e.set_rotations(strain.G, of_rotation);
  return strain;
}

Strains3 tied_shear(const Element& e) {
  constexpr double third = 1. / 3;
  Index points = 0, row = 0;
  for (const quadratic::Tie& tie : e.shape.ties) points += static_cast<Index>(tie.at.size());
  const auto ties = static_cast<Index>(e.shape.ties.size()), of_rotation = 6 * points;
  Strains3 strain = e.empty(ties, e.second_order ? of_rotation + 3 * e.count() : 0);
  for (Index k = 0; k < ties; ++k) {
    const quadratic::Tie& tie = e.shape.ties[static_cast<std::size_t>(k)];
    for (const Point& point : tie.at) {
      const double share = 1 / static_cast<double>(tie.at.size());
      const Surface at = surface_at(e.shape, e.nodes, point);
      const Vector3d X = share * (tie.along.x() * at.r + tie.along.y() * at.s);
      const LocalAxes axes = axes_at(at, X);
      const VectorXd f_t = axes.dN.row(0), f_s = axes.dN.row(1);
      Vector3d D = Vector3d::Zero();
      for (std::size_t i = 0; i < e.director.size(); ++i) D += at.N[static_cast<Index>(i)] * e.director[i];
      e.add_director(strain.L.row(k), X, at.N);
      e.add_displacement(strain.L.row(k), X.norm() * D, f_t);
      if (!e.second_order) continue;
      const Vector3d n = at.normal.normalized();
      e.add_displacement(strain.G.row(row), n, f_t);
      e.add_displacement(strain.G.row(row + 1), axes.x, f_t);
      e.add_displacement(strain.G.row(row + 2), 2 * third * axes.y, f_t);
      e.add_displacement(strain.G.row(row + 2), -third * axes.x, f_s);
      e.add_director(strain.G.row(row + 3), n, at.N);
      e.add_director(strain.G.row(row + 4), axes.x, at.N), e.add_director(strain.G.row(row + 5), axes.y, at.N);
      MatrixXd& P = strain.P[static_cast<std::size_t>(k)];
      multiply(P, row, row + 3, X.norm()), multiply(P, row + 1, row + 4, third * X.norm());
      multiply(P, row + 2, row + 5, X.norm());
      e.add_rotations(P, of_rotation, X, at.N);
      row += 6;
    }
  }
  if (e.second_order) e.set_rotations(strain.G, of_rotation);
  return strain;
}

}  // namespace floe::fem::quadratic
