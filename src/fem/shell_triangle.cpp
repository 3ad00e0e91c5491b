#include "shell_triangle.h"

#include <cmath>
#include <tuple>

namespace floe::fem {
namespace {

using Matrix18 = Eigen::Matrix<double, 18, 18>;

/// K += stressed' rows by blocks of nodes, the upper ones; rows have nothing at the node `without`. Six entries of a
/// column at a time stay in registers.
template <int count>
void add_squares(Matrix18& K, const Eigen::Matrix<double, count, 18>& stressed,
                 const Eigen::Matrix<double, count, 18>& rows, int without = -1) {
  for (int i = 0; i < 3; ++i) {
    if (i == without) continue;
    const Eigen::Matrix<double, 6, count> left = stressed.template middleCols<6>(6 * i).transpose();
    for (int j = 6 * i; j < 18; ++j) {
      if (j / 6 == without) continue;
      Eigen::Matrix<double, 6, 1> sum = K.template block<6, 1>(6 * i, j);
      for (int r = 0; r < count; ++r) sum += left.col(r) * rows(r, j);
      K.template block<6, 1>(6 * i, j) = sum;
    }
  }
}

void mirror(Matrix18& K) {
  for (int j = 0; j < 18; ++j)
    for (int i = j + 1; i < 18; ++i) K(i, j) = K(j, i);
}

/// Stiffness of the deformations from `first` on, of which there are count / 3.
template <int count>
Matrix18 stiffness(const shell::Geometry& g, const ShellSection& section, int first) {
  const shell::Deformations d = shell::deformations(g, section);
  const Eigen::Matrix<double, count, 18> rows = d.rows.middleRows<count>(3 * first);
  Eigen::Matrix<double, count, 18> stressed;
  for (int k = 0; k < count / 3; ++k) {
    const Eigen::Matrix3d S = g.area * d.stiffness[first + k];
    stressed.template middleRows<3>(3 * k) = S.lazyProduct(rows.template middleRows<3>(3 * k));
  }
  Matrix18 K = Matrix18::Zero();
  add_squares<count>(K, stressed, rows);
  mirror(K);
  return K;
}

}  // namespace

Matrix18 shell::triangle_stiffness(const Geometry& geometry, const ShellSection& section) {
  return stiffness<12>(geometry, section, mean_strain);
}

Matrix18 shell_triangle_stiffness(const TriangleNodes& nodes, const ShellSection& section) {
  return shell::triangle_stiffness(shell::geometry(nodes, section.axis), section);
}

Matrix18 shell_triangle_bending(const TriangleNodes& nodes, const ShellSection& section) {
  return stiffness<6>(shell::geometry(nodes, section.axis), section, shell::mean_curvature);
}

ShellStrain shell_triangle_strain(const TriangleNodes& nodes, const ShellSection& section) {
  return shell::triangle_strain(shell::geometry(nodes, section.axis), section);
}

ShellStrain shell::triangle_strain(const Geometry& g, const ShellSection& section) {
  ShellStrain point;
  point.weight = g.area;
  point.D = section.A;
  point.L = shell::deformations(g, section).rows.middleRows<3>(3 * shell::mean_strain);
  point.G.setZero(shell::gradient_rows(section), 18);
  shell::set_gradients(g, section, point.G);
  return point;
}

Matrix18 shell_triangle_mass(const TriangleNodes& nodes, const ShellSection& section) {
  const shell::Geometry g = shell::geometry(nodes, section.axis);
  const double share = std::sqrt(section.mass * g.area / 3);
  Matrix18 M = Matrix18::Zero();
  for (int k = 0; k < 3; ++k) {
    const shell::Middle middle = shell::middle(g, k);
    Eigen::Matrix<double, 5, 18> rows = middle.rows;
    rows.topRows<2>() += section.mass_centre * middle.arms;
    rows.topRows<3>() *= share;
    rows.bottomRows<2>() *= share * section.mass_radius;
    add_squares<5>(M, rows, rows, k);
  }
  mirror(M);
  return M;
}

namespace {

void add_rotations(const shell::Geometry& g, Strains strains, StrainPoint& point) {
  const Eigen::MatrixXd L = point.L;
  std::vector<std::tuple<int, int, Eigen::Vector3d>> products;
  shell::add_rotations(g, strains, L, point.G,
                       [&](int p, int q, const Eigen::Vector3d& C) { products.emplace_back(p, q, C); });
  const Eigen::Index rows = point.G.rows();
  for (std::size_t s = 0; s < point.P.size(); ++s) {
    point.P[s].conservativeResizeLike(Eigen::MatrixXd::Zero(rows, rows));
    for (const auto& [p, q, C] : products) point.P[s](p, q) = point.P[s](q, p) = C[static_cast<Eigen::Index>(s)];
  }
}

}  // namespace

ElementMaps shell_triangle(const TriangleNodes& nodes, const ShellSection& section) {
  return shell::triangle_maps(shell::geometry(nodes, section.axis), nodes, section);
}

ElementMaps shell::triangle_maps(const Geometry& g, const TriangleNodes& nodes, const ShellSection& section) {
  const bool second_order = section.strains == Strains::second_order;
  const ShellStrain strain = triangle_strain(g, section);
  ElementMaps maps;
  const Eigen::Index gradients = strain.G.rows();
  std::vector<Eigen::MatrixXd> P(3, Eigen::MatrixXd::Zero(gradients, gradients));
  for (Eigen::Index x = 0; x < gradients; x += 2)
    P[0](x, x) = 1, P[1](x + 1, x + 1) = 1, P[2](x, x + 1) = P[2](x + 1, x) = 1;
  maps.membrane.push_back({strain.weight, strain.D, strain.L, strain.G, P});
  const shell::Deformations d = shell::deformations(g, section);
  const Eigen::MatrixXd none(0, 0);
  for (const int k : {shell::mean_curvature, shell::edge_bending, shell::drilling})
    if (second_order || k == shell::drilling)
      maps.membrane.push_back(
          {g.area, d.stiffness[k], d.rows.middleRows<3>(3 * k), Eigen::MatrixXd(0, 18), {none, none, none}});
  for (StrainPoint& point : maps.membrane) fem::add_rotations(g, section.strains, point);
  maps.bending = second_order ? Eigen::MatrixXd::Zero(18, 18) : Eigen::MatrixXd(shell_triangle_bending(nodes, section));

  const Eigen::Vector3d centroid = (nodes[0] + nodes[1] + nodes[2]) / 3;
  const double r = section.mass_radius;
  const std::vector<double> heights = r > 0 ? std::vector<double>{-r, r} : std::vector<double>{0};
  for (int k = 0; k < 3; ++k) {
    const shell::Middle middle = shell::middle(g, k);
    for (const double height : heights) {
      const double z = section.mass_centre + height;
      shell::Rows18 N = middle.rows.topRows<3>();
      N.topRows<2>() += section.mass_centre * middle.arms + height * middle.rows.bottomRows<2>();
      const Eigen::Vector3d at(middle.at.x(), middle.at.y(), z);
      maps.mass.push_back({section.mass * g.area / (3.0 * heights.size()), centroid + g.axes * at, g.axes * N});
    }
  }
  return maps;
}

std::vector<SurfacePoint> shell_triangle_surface(const TriangleNodes& nodes) {
  const shell::Geometry g = shell::geometry(nodes, Eigen::Vector3d::Zero());
  std::vector<SurfacePoint> points;
  for (int k = 0; k < 3; ++k) {
    const shell::Edge& edge = g.edge[k];
    points.push_back({g.area / 3, (nodes[edge.from] + nodes[edge.to]) / 2,
                      g.axes * shell::middle(g, k).rows.topRows<3>(), g.axes.col(2)});
  }
  return points;
}

}  // namespace floe::fem
