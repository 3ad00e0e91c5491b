#include <algorithm>
#include <cmath>

#include "floe/error.h"
#include "floe/fem/shell.h"
#include "shell_triangle.h"

namespace floe::fem {
namespace {

/// The four triangles. Their normals agree to less than a right angle, or the element folds back or crosses itself.
std::array<TriangleNodes, 4> triangles(const QuadrilateralNodes& nodes) {
  std::array<TriangleNodes, 4> all;
  std::array<Eigen::Vector3d, 4> normal;
  for (int k = 0; k < 4; ++k) {
    for (int i = 0; i < 3; ++i) all[k][i] = nodes[quadrilateral_triangles[k][i]];
    normal[k] = (all[k][1] - all[k][0]).cross(all[k][2] - all[k][0]);
    for (int other = 0; other < k; ++other)
      if (!(normal[k].dot(normal[other]) > 0)) throw InputError("a quadrilateral shell element is not convex");
  }
  return all;
}

/// rows x 18 of a triangle -> rows x 24
Eigen::MatrixXd widened(const Eigen::MatrixXd& rows, int triangle) {
  Eigen::MatrixXd wide = Eigen::MatrixXd::Zero(rows.rows(), 24);
  for (int i = 0; i < 3; ++i) wide.middleCols<6>(6 * quadrilateral_triangles[triangle][i]) = rows.middleCols<6>(6 * i);
  return wide;
}

template <class Sum, class Part>
void add_half(Sum& sum, const Part& part, int triangle) {
  const auto& node = quadrilateral_triangles[triangle];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      sum.template block<6, 6>(6 * node[i], 6 * node[j]) += part.template block<6, 6>(6 * i, 6 * j) / 2;
}

using Matrix24 = Eigen::Matrix<double, 24, 24>;

}  // namespace

Matrix24 shell_quadrilateral_stiffness(const QuadrilateralNodes& nodes, const ShellSection& section) {
  Matrix24 K = Matrix24::Zero();
  const auto parts = triangles(nodes);
  for (int k = 0; k < 4; ++k) {
    const shell::Geometry g = shell::geometry(parts[k], section.axis, shell::corner_normals(nodes, k));
    add_half(K, shell::triangle_stiffness(g, section), k);
  }
  return K;
}

Matrix24 shell_quadrilateral_mass(const QuadrilateralNodes& nodes, const ShellSection& section) {
  Matrix24 M = Matrix24::Zero();
  const auto parts = triangles(nodes);
  for (int k = 0; k < 4; ++k) add_half(M, shell_triangle_mass(parts[k], section), k);
  return M;
}

shell::Normals shell::corner_normals(const QuadrilateralNodes& nodes, int triangle) {
  constexpr double flat = 1e-8;  // relative to its size: drilling that bends so little locks nothing
  Normals normals{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  const Eigen::Vector3d first = nodes[2] - nodes[0], second = nodes[3] - nodes[1];
  const double size = std::max(first.norm(), second.norm());
  if (std::abs((nodes[1] - nodes[0]).dot(first.cross(second))) < flat * size * size * size) return normals;
  for (int i = 0; i < 3; ++i) {
    const auto at = static_cast<std::size_t>(quadrilateral_triangles[triangle][i]);
    normals[i] = (nodes[(at + 1) % 4] - nodes[at]).cross(nodes[(at + 3) % 4] - nodes[at]);
  }
  return normals;
}

ElementMaps shell_quadrilateral_part(const QuadrilateralNodes& nodes, int triangle, const ShellSection& section) {
  TriangleNodes corners;
  for (int i = 0; i < 3; ++i) corners[i] = nodes[quadrilateral_triangles[triangle][i]];
  const shell::Geometry g = shell::geometry(corners, section.axis, shell::corner_normals(nodes, triangle));
  return shell::triangle_maps(g, corners, section);
}

ElementMaps shell_quadrilateral(const QuadrilateralNodes& nodes, const ShellSection& section) {
  triangles(nodes);
  ElementMaps maps;
  maps.bending = Eigen::MatrixXd::Zero(24, 24);
  for (int k = 0; k < 4; ++k) {
    const ElementMaps part = shell_quadrilateral_part(nodes, k, section);
    add_half(maps.bending, part.bending, k);
    for (const StrainPoint& p : part.membrane)
      maps.membrane.push_back({p.weight / 2, p.D, widened(p.L, k), widened(p.G, k), p.P});
    for (const body::MassPoint& p : part.mass) maps.mass.push_back({p.mass / 2, p.x, widened(p.N, k)});
  }
  return maps;
}

std::vector<SurfacePoint> shell_quadrilateral_surface(const QuadrilateralNodes& nodes) {
  const auto parts = triangles(nodes);
  std::vector<SurfacePoint> points;
  for (int k = 0; k < 4; ++k)
    for (const SurfacePoint& p : shell_triangle_surface(parts[k]))
      points.push_back({p.area / 2, p.x, widened(p.N, k), p.normal});
  return points;
}

}  // namespace floe::fem
