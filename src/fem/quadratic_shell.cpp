#include "floe/fem/quadratic_shell.h"

#include <cmath>
#include <optional>

#include "floe/error.h"
#include "quadratic_strains.h"

namespace floe::fem {

using namespace quadratic;
using math::skew;

namespace {

/// first + C second.
Strains3 coupled(const Strains3& first, const Matrix3d& C, const Strains3& second) {
  const Index before = first.G.rows(), more = second.G.rows();
  Strains3 sum{first.L + C * second.L, MatrixXd(before + more, first.G.cols()), {}};
  sum.G << first.G, second.G;
  for (Index s = 0; s < 3; ++s) {
    MatrixXd& P = sum.P.emplace_back(MatrixXd::Zero(before + more, before + more));
    P.topLeftCorner(before, before) = first.P[static_cast<std::size_t>(s)];
    for (Index t = 0; t < 3; ++t) P.bottomRightCorner(more, more) += C(s, t) * second.P[static_cast<std::size_t>(t)];
  }
  return sum;
}

StrainPoint point_of(double weight, const MatrixXd& D, Strains3 strain) {
  return {weight, D, std::move(strain.L), std::move(strain.G), std::move(strain.P)};
}

/// n.theta - 1/2 n.curl u at the nodes.
StrainPoint drilling(const Element& e, double area) {
  Strains3 strain = e.empty(e.count(), 0);
  for (Index i = 0; i < e.count(); ++i) {
    const Surface at = surface_at(e.shape, e.nodes, e.shape.nodes[static_cast<std::size_t>(i)]);
    const LocalAxes axes = axes_at(at, Vector3d::Zero());
    auto row = strain.L.row(i);
    row.segment<3>(6 * i + 3) = e.director[static_cast<std::size_t>(i)].transpose();
    e.add_displacement(row, -axes.y / 2, axes.dN.row(0));
    e.add_displacement(row, axes.x / 2, axes.dN.row(1));
  }
  const double stiffness = drilling_share * e.section.A(2, 2) / static_cast<double>(e.count());
  return point_of(area, stiffness * MatrixXd::Identity(e.count(), e.count()), std::move(strain));
}

/// Of the shear at the ties. That inside of a triangle stands in series with the bending of a bubble that would follow
/// it, as if the rotations had that bubble: else thin triangles lock.
MatrixXd shear_stiffness(const Element& e) {
  const auto ties = static_cast<Index>(e.shape.ties.size());
  MatrixXd all = MatrixXd::Zero(ties, ties);
  Matrix2d inside = Matrix2d::Zero(), bubble = Matrix2d::Zero();
  const bool apart = e.shape.inside.size() > 0;
  Matrix2d contravariant;  // of directors at the middle, in its axes
  if (apart)
    contravariant = axes_at(surface_at(e.shape, e.nodes, e.shape.ties.back().at[0]), e.section.axis).from_covariant;
  for (const auto& [point, weight] : e.shape.masses) {
    const Surface at = surface_at(e.shape, e.nodes, point);
    const LocalAxes axes = axes_at(at, e.section.axis);
    const double share = weight * at.normal.norm();
    const Matrix2Xd B = axes.from_covariant * e.shape.shears(point) * e.shape.from_ties;
    all += share * e.section.shear * B.transpose() * B;
    if (!apart) continue;
    const Matrix2Xd own = axes.from_covariant * e.shape.shears(point) * e.shape.from_inside;
    inside += share * e.section.shear * own.transpose() * own;
    const Eigen::Vector2d b = axes.from_covariant * Shape::bubble_gradient(point);
    Eigen::Matrix<double, 3, 2> kappa;
    kappa << b.x(), 0, 0, b.y(), b.y(), b.x();
    kappa *= contravariant;
    bubble += share * kappa.transpose() * e.section.bending * kappa;
  }
  if (apart) all += e.shape.inside.transpose() * (inside.inverse() + bubble.inverse()).inverse() * e.shape.inside;
  return all;
}

void add_strains(const Element& e, ElementMaps& maps) {
  std::vector<StrainPoint> bent;
  double area = 0;
  const bool couples = !e.section.coupling.isZero(0);
  std::optional<TiedMembrane> tied;
  if (!e.shape.membrane.empty()) tied.emplace(e);
  for (const auto& [point, weight] : e.shape.strains) {
    const Surface at = surface_at(e.shape, e.nodes, point);
    if (!(at.normal.dot(e.director[0]) > 0)) throw InputError("a shell element of second order is folded");
    const LocalAxes axes = axes_at(at, tied ? tied->axis : e.section.axis);
    const double share = weight * at.normal.norm();
    area += share;
    Strains3 strain = tied ? tied_membrane(e, tied->at(point)) : membrane(e, at, axes),
             bending = curvature(e, at, axes);
    maps.membrane.push_back(
        point_of(share, e.section.A, couples ? coupled(strain, e.section.coupling, bending) : std::move(strain)));
    bent.push_back(point_of(share, e.section.bending, std::move(bending)));
  }
  std::move(bent.begin(), bent.end(), std::back_inserter(maps.membrane));
  maps.membrane.push_back(point_of(1, shear_stiffness(e), tied_shear(e)));
  maps.membrane.push_back(drilling(e, area));
  maps.bending = MatrixXd::Zero(e.dofs(), e.dofs());
}

/// sum N_i u_i + z sum N_i theta_i x n_i
MatrixXd motion(const Element& e, const VectorXd& N, double z) {
  MatrixXd rows = MatrixXd::Zero(3, e.dofs());
  e.set_displacements(rows, 0, 1, N);
  if (z != 0) e.set_directors(rows, 0, 1, z * N);
  return rows;
}

}  // namespace

ElementMaps quadratic_shell(ShellNodes nodes, const ShellSection& section) {
  const Element e(nodes, section);
  ElementMaps maps;
  add_strains(e, maps);
  const double r = section.mass_radius;
  const std::vector<double> heights = r > 0 ? std::vector<double>{-r, r} : std::vector<double>{0};
  for (const auto& [point, weight] : e.shape.masses) {
    const Surface at = surface_at(e.shape, nodes, point);
    Vector3d D = Vector3d::Zero();
    for (std::size_t i = 0; i < nodes.size(); ++i) D += at.N[static_cast<Index>(i)] * e.director[i];
    const double mass = section.mass * weight * at.normal.norm() / static_cast<double>(heights.size());
    for (const double height : heights) {
      const double z = section.mass_centre + height;
      maps.mass.push_back({mass, at.at + z * D, motion(e, at.N, z)});
    }
  }
  return maps;
}

std::vector<CurvedPoint> quadratic_shell_surface(ShellNodes nodes) {
  const Shape& shape = quadratic::shape_of(nodes.size());
  std::vector<CurvedPoint> points;
  for (const auto& [point, weight] : shape.masses) {
    const Surface at = surface_at(shape, nodes, point);
    const double area = at.normal.norm();
    MatrixXd N = MatrixXd::Zero(3, 6 * at.N.size()), tilt = N;
    for (Index i = 0; i < at.N.size(); ++i) {
      N.middleCols<3>(6 * i) = at.N[i] * Matrix3d::Identity();
      tilt.middleCols<3>(6 * i) = (at.dN(1, i) * skew(at.r) - at.dN(0, i) * skew(at.s)) / area;
    }
    points.push_back({{weight * area, at.at, N, at.normal / area}, tilt});
  }
  return points;
}

std::vector<Matrix3d> surface_axes(ShellNodes nodes) {
  const Shape& shape = quadratic::shape_of(nodes.size());
  std::vector<Matrix3d> all;
  for (const Point& node : shape.nodes) {
    const Surface at = surface_at(shape, nodes, node);
    const LocalAxes axes = axes_at(at, Vector3d::Zero());
    all.emplace_back();
    all.back() << axes.x, axes.y, at.normal.normalized();
  }
  return all;
}

std::vector<NodeShare> quadratic_shell_shares(ShellNodes nodes) {
  const Shape& shape = quadratic::shape_of(nodes.size());
  std::vector<NodeShare> shares(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    NodeShare& own = shares[i];
    for (const auto& [point, weight] : shape.of_node[i]) {
      const Surface at = surface_at(shape, nodes, point);
      const double area = weight * at.normal.norm();
      own.area += area, own.centre += area * at.at, own.normal += weight * at.normal;
      own.spread += area * at.at * at.at.transpose();
    }
    own.centre /= own.area;
    own.spread -= own.area * own.centre * own.centre.transpose();
    own.normal.normalize();
  }
  return shares;
}

}  // namespace floe::fem
