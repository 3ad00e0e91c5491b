#include "floe/fem/shell_samples.h"

#include <numeric>

#include "floe/fem/shell.h"
#include "quadratic_strains.h"
#include "shell_triangle.h"

namespace floe::fem {
namespace {

/// Of two strain points with gradients of their own, three strains each.
void put_together(const StrainPoint& membrane, const StrainPoint& bending, ShellSample& sample) {
  const Eigen::Index m = membrane.G.rows(), b = bending.G.rows();
  sample.L.resize(6, membrane.L.cols()), sample.L << membrane.L, bending.L;
  sample.G.resize(m + b, membrane.L.cols()), sample.G << membrane.G, bending.G;
  for (std::size_t i = 0; i < 6; ++i) {
    Eigen::MatrixXd& P = sample.P.emplace_back(Eigen::MatrixXd::Zero(m + b, m + b));
    if (i < 3)
      P.topLeftCorner(m, m) = membrane.P[i];
    else if (b > 0)
      P.bottomRightCorner(b, b) = bending.P[i - 3];
  }
}

ShellSample of_triangle(const TriangleNodes& nodes, const shell::Geometry& geometry, const ShellSection& section) {
  ShellSample sample;
  sample.axes = geometry.axes;
  for (const Eigen::Vector3d& x : nodes) sample.at += x / 3;
  for (const Eigen::Vector3d& x : nodes) sample.spread += (x - sample.at) * (x - sample.at).transpose() / 12;
  const ElementMaps maps = shell::triangle_maps(geometry, nodes, section);
  if (section.strains == Strains::second_order) {
    put_together(maps.membrane[0], maps.membrane[1], sample);
    return sample;
  }
  const Eigen::MatrixXd none(0, 0), no_gradients(0, 18);
  const shell::Deformations d = shell::deformations(geometry, section);
  put_together(maps.membrane[0],
               {1, none, d.rows.middleRows<3>(3 * shell::mean_curvature), no_gradients, {none, none, none}}, sample);
  return sample;
}

std::vector<ShellSample> of_second_order(ShellNodes nodes, const ShellSection& section) {
  const quadratic::Element e(nodes, section);
  const ElementMaps maps = quadratic_shell(nodes, section);
  const std::size_t count = quadratic_membrane_points(nodes.size());
  const Eigen::Vector3d axis = e.shape.membrane.empty() ? section.axis : quadratic::TiedMembrane(e).axis;
  std::vector<ShellSample> samples;
  for (std::size_t i = 0; i < count; ++i) {
    const quadratic::Surface at = quadratic::surface_at(e.shape, nodes, e.shape.strains[i].at);
    const quadratic::LocalAxes axes = quadratic::axes_at(at, axis);
    ShellSample& sample = samples.emplace_back();
    sample.at = at.at;
    sample.axes << axes.x, axes.y, at.normal.normalized();
    put_together(maps.membrane[i], maps.membrane[count + i], sample);
  }
  return samples;
}

}  // namespace

std::vector<ShellSample> shell_samples(const Structure& structure, const Mesh::Cell& cell) {
  const ShellSection section = on_curved_surface(std::get<ShellSection>(structure.sections[cell.part]), cell.rise);
  std::vector<Eigen::Vector3d> x;
  for (const int node : cell.places()) x.push_back(structure.mesh.positions[node]);
  std::vector<ShellSample> samples;
  std::vector<int> all(x.size());
  std::iota(all.begin(), all.end(), 0);
  if (mesh::is_quadratic(cell.kind)) {
    samples = of_second_order(x, section);
    for (ShellSample& sample : samples) sample.corners = all;
    return samples;
  }
  if (cell.kind == CellKind::triangle) {
    const TriangleNodes nodes{x[0], x[1], x[2]};
    samples.push_back(of_triangle(nodes, shell::geometry(nodes, section.axis), section));
    samples[0].corners = all;
    return samples;
  }
  for (int k = 0; k < 4; ++k) {
    const auto& corners = quadrilateral_triangles[k];
    const TriangleNodes nodes{x[corners[0]], x[corners[1]], x[corners[2]]};
    const shell::Normals normals = shell::corner_normals({x[0], x[1], x[2], x[3]}, k);
    samples.push_back(of_triangle(nodes, shell::geometry(nodes, section.axis, normals), section));
    samples.back().corners = {corners.begin(), corners.end()};
    samples.back().share = 0.25;
  }
  const Eigen::Vector3d middle = (x[0] + x[1] + x[2] + x[3]) / 4;
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const ShellSample& one : samples) spread += (one.spread + (one.at - middle) * (one.at - middle).transpose()) / 4;
  for (ShellSample& one : samples) one.at = middle, one.spread = spread;
  return samples;
}

}  // namespace floe::fem
