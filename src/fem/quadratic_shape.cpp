#include "quadratic_shape.h"

#include <array>
#include <cmath>

namespace floe::fem::quadratic {
namespace {

using Eigen::Matrix2Xd;
using Eigen::VectorXd;

const double gauss2 = 1 / std::sqrt(3.0), gauss3 = std::sqrt(0.6);

constexpr std::array<std::array<int, 2>, 4> corner_signs{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};

VectorXd values8(const Point& at) {
  const double r = at.x(), s = at.y();
  VectorXd N(8);
  for (int i = 0; i < 4; ++i) {
    const double a = r * corner_signs[i][0], b = s * corner_signs[i][1];
    N[i] = (1 + a) * (1 + b) * (a + b - 1) / 4;
  }
  N[4] = (1 - r * r) * (1 - s) / 2, N[6] = (1 - r * r) * (1 + s) / 2;
  N[5] = (1 + r) * (1 - s * s) / 2, N[7] = (1 - r) * (1 - s * s) / 2;
  return N;
}

Matrix2Xd gradients8(const Point& at) {
  const double r = at.x(), s = at.y();
  Matrix2Xd dN(2, 8);
  for (int i = 0; i < 4; ++i) {
    const double p = corner_signs[i][0], q = corner_signs[i][1], a = r * p, b = s * q;
    dN(0, i) = p * (1 + b) * (2 * a + b) / 4;
    dN(1, i) = q * (1 + a) * (a + 2 * b) / 4;
  }
  dN.col(4) << -r * (1 - s), -(1 - r * r) / 2;
  dN.col(6) << -r * (1 + s), (1 - r * r) / 2;
  dN.col(5) << (1 - s * s) / 2, -s * (1 + r);
  dN.col(7) << -(1 - s * s) / 2, -s * (1 - r);
  return dN;
}

VectorXd values6(const Point& at) {
  const double r = at.x(), s = at.y(), t = 1 - r - s;
  VectorXd N(6);
  N << t * (2 * t - 1), r * (2 * r - 1), s * (2 * s - 1), 4 * t * r, 4 * r * s, 4 * s * t;
  return N;
}

Matrix2Xd gradients6(const Point& at) {
  const double r = at.x(), s = at.y(), t = 1 - r - s;
  Matrix2Xd dN(2, 6);
  dN << 1 - 4 * t, 4 * r - 1, 0, 4 * (t - r), 4 * s, -4 * s,  //
      1 - 4 * t, 0, 4 * s - 1, -4 * r, 4 * r, 4 * (t - s);
  return dN;
}

/// 1, r, s, r s, s^2 along r and 1, r, s, r s, r^2 along s.
Matrix2Xd shears8(const Point& at) {
  const double r = at.x(), s = at.y();
  Matrix2Xd f(2, 10);
  f << 1, 0, r, 0, s, 0, r * s, 0, s * s, 0,  //
      0, 1, 0, r, 0, s, 0, r * s, 0, r * r;
  return f;
}

/// 1, r, s of either component and (s, -r) times r and s.
Matrix2Xd shears6(const Point& at) {
  const double r = at.x(), s = at.y();
  Matrix2Xd f(2, 8);
  f << 1, 0, r, 0, s, 0, r * s, s * s,  //
      0, 1, 0, r, 0, s, -r * r, -r * s;
  return f;
}

/// Two Gauss points of each edge, and the mean of either component along the middle line.
void add_ties(std::size_t corners, const std::array<std::vector<Point>, 2>& inside, Shape& shape) {
  for (std::size_t i = 0; i < corners; ++i) {
    const Point from = shape.nodes[i], to = shape.nodes[(i + 1) % corners];
    for (const double at : {-gauss2, gauss2})
      shape.ties.push_back({to - from, {(from + to) / 2 + at / 2 * (to - from)}});
  }
  shape.ties.push_back({{1, 0}, inside[0]});
  shape.ties.push_back({{0, 1}, inside[1]});
  const auto n = static_cast<Eigen::Index>(shape.ties.size());
  Eigen::MatrixXd at_ties = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index k = 0; k < n; ++k)
    for (const Point& at : shape.ties[k].at)
      at_ties.row(k) +=
          shape.ties[k].along.transpose() * shape.shears(at) / static_cast<double>(shape.ties[k].at.size());
  shape.from_ties = at_ties.inverse();
}

/// Takes those inside apart.
void separate_inside(Shape& shape) {
  constexpr Eigen::Index edges = 6;
  const Point& middle = shape.ties[edges].at[0];
  Eigen::MatrixXd on_edges(edges, edges);
  for (Eigen::Index k = 0; k < edges; ++k)
    on_edges.row(k) = shape.ties[k].along.transpose() * shape.shears(shape.ties[k].at[0]).leftCols(edges);
  Eigen::MatrixXd linear = Eigen::MatrixXd::Zero(edges + 2, edges + 2);  // coefficients, from ties
  linear.topLeftCorner(edges, edges) = on_edges.inverse();
  shape.inside.setZero(2, edges + 2);
  shape.inside.leftCols(edges) = -shape.shears(middle).leftCols(edges) * on_edges.inverse();
  shape.inside.rightCols(2).setIdentity();
  shape.from_inside = shape.from_ties.rightCols(2);
  shape.from_ties = linear;
}

/// Points of a fine midpoint rule, shared among the nodes that are nearest.
void add_shares(const std::vector<WeightedPoint>& fine, bool triangle, Shape& shape) {
  shape.of_node.resize(shape.nodes.size());
  const auto distance = [&](const Point& a, const Point& b) {  // of a triangle: the same for all its corners
    const Point d = a - b;
    return d.squaredNorm() + (triangle ? d.x() * d.y() : 0);
  };
  for (const WeightedPoint& point : fine) {
    double least = INFINITY;
    for (const Point& node : shape.nodes) least = std::min(least, distance(point.at, node));
    std::vector<std::size_t> nearest;
    for (std::size_t i = 0; i < shape.nodes.size(); ++i)
      if (distance(point.at, shape.nodes[i]) < least + 1e-9) nearest.push_back(i);
    for (const std::size_t i : nearest)
      shape.of_node[i].push_back({point.at, point.weight / static_cast<double>(nearest.size())});
  }
}

Shape quadrilateral() {
  Shape shape{values8, gradients8, {}, {}, {}, {}, {}, {}, {}, {}, shears8, {}};
  for (const auto& [p, q] : corner_signs) shape.nodes.emplace_back(p, q);
  for (int i = 0; i < 4; ++i) shape.nodes.emplace_back((shape.nodes[i] + shape.nodes[(i + 1) % 4]) / 2);
  for (const auto& [p, q] : corner_signs) shape.strains.push_back({Point(p, q) * gauss2, 1});
  for (int i = -1; i <= 1; ++i)
    for (int j = -1; j <= 1; ++j)
      shape.masses.push_back({Point(i, j) * gauss3, (i == 0 ? 8. : 5.) * (j == 0 ? 8. : 5.) / 81});
  add_ties(4, {{{{-gauss2, 0}, {gauss2, 0}}, {{0, -gauss2}, {0, gauss2}}}}, shape);
  std::vector<WeightedPoint> fine;
  constexpr int n = 8;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) fine.push_back({Point((2. * i + 1) / n - 1, (2. * j + 1) / n - 1), 4. / (n * n)});
  add_shares(fine, false, shape);
  return shape;
}

/// Degree 4. Source: Strang & Fix 1973; Dunavant 1985.
std::vector<WeightedPoint> six_points() {
  std::vector<WeightedPoint> points;
  for (const auto& [a, weight] :
       {std::pair(0.44594849091596488632, 0.22338158967801146570), {0.09157621350977074346, 0.10995174365532186764}})
    for (const Point& at : {Point(a, a), Point(1 - 2 * a, a), Point(a, 1 - 2 * a)}) points.push_back({at, weight / 2});
  return points;
}

Shape triangle() {
  Shape shape{values6, gradients6, {}, {}, {}, {}, {}, {}, {}, {}, shears6, {}};
  shape.nodes = {{0, 0}, {1, 0}, {0, 1}, {0.5, 0}, {0.5, 0.5}, {0, 0.5}};
  for (const Point& at : {Point(1. / 6, 1. / 6), Point(2. / 3, 1. / 6), Point(1. / 6, 2. / 3)})
    shape.strains.push_back({at, 1. / 6});
  shape.masses = six_points();
  const Point middle(1. / 3, 1. / 3);
  add_ties(3, {{{middle}, {middle}}}, shape);
  separate_inside(shape);
  const double a = (1 - gauss2) / 2, b = (1 + gauss2) / 2, c = gauss2;
  for (const Point& at : {Point(a, 0), Point(b, 0), Point(a, c)}) shape.membrane.push_back({{1, 0}, {at}});
  for (const Point& at : {Point(0, a), Point(0, b), Point(c, a)}) shape.membrane.push_back({{0, 1}, {at}});
  for (const Point& at : {Point(b, a), Point(a, b), Point(a, a)}) shape.membrane.push_back({{-1, 1}, {at}});
  std::vector<WeightedPoint> fine;
  constexpr int n = 8;
  const double h = 1. / n;
  for (int i = 0; i < n; ++i)
    for (int j = 0; i + j < n; ++j) {
      fine.push_back({Point((i + 1. / 3) * h, (j + 1. / 3) * h), h * h / 2});
      if (i + j < n - 1) fine.push_back({Point((i + 2. / 3) * h, (j + 2. / 3) * h), h * h / 2});
    }
  add_shares(fine, true, shape);
  return shape;
}

}  // namespace

Point Shape::bubble_gradient(const Point& at) {
  const double r = at.x(), s = at.y(), t = 1 - r - s;
  return 27 * Point(s * (t - r), r * (t - s));
}

const Shape& shape_of(std::size_t nodes) {
  static const Shape three = triangle(), four = quadrilateral();
  return nodes == 6 ? three : four;
}

}  // namespace floe::fem::quadratic
