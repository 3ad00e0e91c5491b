#include "floe/fem/pressure.h"

#include "cells.h"
#include "floe/fem/quadratic_shell.h"
#include "quadratic_shape.h"

namespace floe::fem {
namespace {

using Eigen::Vector3d;

/// Change of a triangle's area vector over its area, 3 x dofs of the cell. @param corner  of the triangle in the cell
Eigen::MatrixXd tilt(const std::array<Vector3d, 4>& x, const std::array<int, 3>& corner, Eigen::Index dofs) {
  const Vector3d twice = (x[corner[1]] - x[corner[0]]).cross(x[corner[2]] - x[corner[0]]), n = twice.normalized();
  Eigen::MatrixXd L = Eigen::MatrixXd::Zero(3, dofs);
  for (int i = 0; i < 3; ++i) {
    const Vector3d opposite = x[corner[(i + 2) % 3]] - x[corner[(i + 1) % 3]];
    const Vector3d gradient = n.cross(opposite) / twice.norm();  // of the corner's barycentric coordinate
    L.middleCols<3>(6 * corner[i]) = n * gradient.transpose() - gradient * n.transpose();
  }
  return L;
}

}  // namespace

std::vector<SurfaceShape> surface_shapes(mesh::CellKind kind) {
  std::vector<SurfaceShape> points;
  if (mesh::is_quadratic(kind)) {
    const quadratic::Shape& shape = quadratic::shape_of(kind == CellKind::triangle6 ? 6 : 8);
    for (const auto& [point, weight] : shape.masses)
      points.push_back({weight, shape.values(point), shape.gradients(point)});
    return points;
  }
  const auto add = [&](const std::array<int, 3>& corner, int corners, double weight) {
    SurfaceShape one{weight, Eigen::VectorXd::Zero(corners), Eigen::Matrix2Xd::Zero(2, corners)};
    for (const int i : corner) one.N[i] = 1. / 3;
    one.dN.col(corner[0]).setConstant(-1), one.dN(0, corner[1]) = 1, one.dN(1, corner[2]) = 1;
    points.push_back(one);
  };
  if (kind == CellKind::triangle) add({0, 1, 2}, 3, 0.5);
  if (kind == CellKind::quadrilateral)
    for (const auto& corners : quadrilateral_triangles) add(corners, 4, 0.25);
  return points;
}

bool is_shell(const Mesh::Cell& cell) { return mesh::is_shell(cell.kind); }

namespace {

body::Pressure curved_pressure(const Structure& structure, const Mesh::Cell& cell) {
  std::vector<Vector3d> x;
  for (const int node : cell.places()) x.push_back(structure.mesh.positions[node]);
  body::Pressure own(6 * static_cast<Eigen::Index>(x.size()));
  for (const CurvedPoint& point : quadratic_shell_surface(x))
    own.add(point.at.area, point.at.x, point.at.normal, point.at.N, point.tilt);
  return own;
}

}  // namespace

body::Pressure pressure(const Structure& structure, const Mesh::Cell& cell) {
  if (mesh::is_quadratic(cell.kind)) {
    const body::Pressure own = curved_pressure(structure, cell);
    return cell.follows() ? body::projected(own, following(structure.mesh, cell)) : own;
  }
  std::array<Vector3d, 4> x;
  const auto corners = cell.corners();
  for (std::size_t i = 0; i < corners.size(); ++i) x[i] = structure.mesh.positions[corners[i]];
  const Eigen::Index dofs = 6 * static_cast<Eigen::Index>(corners.size());
  const bool three = cell.kind == CellKind::triangle;
  const std::vector<SurfacePoint> points =
      three ? shell_triangle_surface({x[0], x[1], x[2]}) : shell_quadrilateral_surface(x);
  body::Pressure own(dofs);
  for (std::size_t p = 0; p < points.size(); ++p) {  // three points of each triangle
    const std::array<int, 3> corner = three ? std::array<int, 3>{0, 1, 2} : quadrilateral_triangles[p / 3];
    own.add(points[p].area, points[p].x, points[p].normal, points[p].N, tilt(x, corner, dofs));
  }
  return cell.follows() ? body::projected(own, following(structure.mesh, cell)) : own;
}

}  // namespace floe::fem
