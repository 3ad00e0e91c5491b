#include <algorithm>

#include "floe/error.h"
#include "shell_triangle.h"

namespace floe::fem::shell {

Geometry geometry(const TriangleNodes& nodes, const Eigen::Vector3d& axis) {
  Geometry g;
  const Eigen::Vector3d first = nodes[1] - nodes[0], second = nodes[2] - nodes[0], normal = first.cross(second);
  const double twice = normal.norm();
  if (!(twice > 1e-12 * std::max({first.squaredNorm(), second.squaredNorm(), (second - first).squaredNorm()})))
    throw InputError("a shell element has no area");
  const Eigen::Vector3d z = normal / twice, wanted = axis.isZero(0) ? first : axis, x = wanted - z.dot(wanted) * z;
  const double length = x.norm();
  if (!(length > 1e-6 * wanted.norm())) throw InputError("the axis of a shell's section is normal to an element");
  g.area = twice / 2;
  g.axes.col(0) = x / length;
  g.axes.col(1) = z.cross(g.axes.col(0));
  g.axes.col(2) = z;
  const Eigen::Vector3d centroid = (nodes[0] + nodes[1] + nodes[2]) / 3;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d arm = nodes[i] - centroid;
    g.corner[i] = {g.axes.col(0).dot(arm), g.axes.col(1).dot(arm)};
  }
  for (int k = 0; k < 3; ++k) {
    const int from = (k + 1) % 3, to = (k + 2) % 3;
    const Eigen::Vector2d along = g.corner[to] - g.corner[from];
    g.edge[k] = {from, to, along, 1.5 / along.squaredNorm()};
    g.gradient[k] = Eigen::Vector2d(-along.y(), along.x()) / twice;
  }
  return g;
}

Geometry geometry(const TriangleNodes& nodes, const Eigen::Vector3d& axis, const Normals& normals) {
  Geometry g = geometry(nodes, axis);
  constexpr double least = 0.5;  // of corners that are all but straight the normal says nothing
  for (int i = 0; i < 3; ++i)
    if (const Eigen::Vector3d n = g.axes.transpose() * normals[i]; n.z() > least * n.norm())
      g.tilt[i] = n.head<2>() / n.z();
  return g;
}

Middle middle(const Geometry& geometry, int k) {
  const Edge& edge = geometry.edge[k];
  Middle m;
  m.at = -geometry.corner[k] / 2;
  m.rows.setZero();
  for (int node : {edge.from, edge.to}) {
    for (int d = 0; d < 3; ++d) m.rows(d, 6 * node + d) = 0.5;
    add_beta(m.rows.row(3), node, {0.5, 0});
    add_beta(m.rows.row(4), node, {0, 0.5});
  }
  add_beta(m.rows.row(2), edge.to, edge.along / 8);
  add_beta(m.rows.row(2), edge.from, -edge.along / 8);
  m.arms = m.rows.bottomRows<2>();
  for (int d = 0; d < 2; ++d) add_edge_bending(m.rows.row(3 + d), edge, -edge.along[d]);
  to_body_axes(m.rows, geometry.axes);
  to_body_axes(m.arms, geometry.axes);
  return m;
}

}  // namespace floe::fem::shell
