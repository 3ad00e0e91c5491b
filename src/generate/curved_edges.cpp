#include "curved_edges.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace floe::generate {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

bool is_flat_shell(CellKind kind) { return is_shell(kind) && !is_quadratic(kind); }

bool folded(const Vector3d& one, const Vector3d& other) { return one.cross(other).norm() >= std::sin(2 * fold); }

/// Of an arc over the middle of its chord; none where the angle between them is round-off.
double rise(double chord, double sine) {
  constexpr double round_off = 1e-8;
  if (std::abs(sine) < round_off) return 0;
  return chord / 2 * sine / (1 + std::sqrt(std::max(0., 1 - sine * sine)));
}

double harmonic_mean(double p, double q) { return p * q > 0 ? 2 * p * q / (p + q) : 0; }

}  // namespace

CurvedEdges::CurvedEdges(const RawMesh& whole) : whole_(whole), at_(whole.positions.size()) {
  for (std::size_t c = 0; c < whole.cells.size(); ++c)
    if (const Cell& cell = whole.cells[c]; is_flat_shell(cell.kind))
      for (int i = 0; i < corner_count(cell.kind); ++i) at_[cell.nodes[i]].push_back(static_cast<PetscInt>(c));
}

/// The corners before and after one.
std::array<PetscInt, 2> CurvedEdges::beside(PetscInt cell, PetscInt node) const {
  const auto& nodes = whole_.cells[cell].nodes;
  const auto n = corner_count(whole_.cells[cell].kind);
  const auto i = std::find(nodes.begin(), nodes.end(), node) - nodes.begin();
  return {nodes[(i + n - 1) % n], nodes[(i + 1) % n]};
}

FacetCorner CurvedEdges::facet(PetscInt cell, PetscInt node) const {
  const auto [previous, next] = beside(cell, node);
  return {whole_.positions[previous], whole_.positions[node], whole_.positions[next]};
}

std::vector<CurvedEdges::Corner> CurvedEdges::surface(PetscInt cell, PetscInt node) const {
  const Vector3d own = facet(cell, node).normal;
  std::vector<Corner> corners;
  for (const PetscInt other : at_[node])
    if (const FacetCorner one = facet(other, node); !folded(one.normal, own)) corners.push_back({other, one});
  return corners;
}

Vector3d CurvedEdges::middle(PetscInt cell) const {
  const int n = corner_count(whole_.cells[cell].kind);
  Vector3d sum = Vector3d::Zero();
  for (int i = 0; i < n; ++i) sum += whole_.positions[whole_.cells[cell].nodes[i]];
  return sum / n;
}

CurvedEdges::Slope CurvedEdges::slope(PetscInt cell, PetscInt node, PetscInt other) const {
  const Vector3d d = from(node, other);
  Matrix3d sum = Matrix3d::Zero();
  double angles = 0, ahead = 0;
  for (const Corner& one : surface(cell, node)) {
    sum += one.facet.weighted();
    angles += one.facet.angle;
    ahead += one.facet.angle * (middle(one.cell) - whole_.positions[node]).dot(d) / d.squaredNorm();
  }
  const double known = 1 - 2 * ahead / angles;
  const Vector3d normal = surface_normal(sum);
  const double sine = -d.dot(normal) / d.norm();
  return {normal.dot(facet(cell, node).normal) < 0 ? -sine : sine, known};
}

/// Unit tangent at `node` of the circle through it, `other` and the node before it along a rim of the surface.
std::optional<Vector3d> CurvedEdges::tangent_of_rim(PetscInt cell, PetscInt node, PetscInt other) const {
  std::map<PetscInt, int> ends;  // of the surface's edges at the node: how many elements each has
  for (const Corner& one : surface(cell, node))
    for (const PetscInt end : beside(one.cell, node)) ++ends[end];
  ends.erase(other);
  std::erase_if(ends, [](const auto& end) { return end.second != 1; });
  if (ends.size() != 1) return {};
  const Vector3d back = from(ends.begin()->first, node), on = from(node, other);
  if (back.dot(on) < std::cos(2 * fold) * back.norm() * on.norm()) return {};
  return (back / back.squaredNorm() + on / on.squaredNorm()).normalized();
}

double CurvedEdges::rise_of_rim(PetscInt cell, PetscInt a, PetscInt b, const Vector3d& axis) const {
  const double length = from(a, b).norm();
  const auto first = tangent_of_rim(cell, a, b), last = tangent_of_rim(cell, b, a);
  const auto along = [&](const Vector3d& tangent) { return rise(length, tangent.dot(axis)); };
  if (first && last) return harmonic_mean(along(*first), along(*last));
  return first ? along(*first) : last ? along(*last) : 0;
}

double CurvedEdges::rise_inside(const std::vector<PetscInt>& shells, PetscInt cell, PetscInt a, PetscInt b,
                                bool diagonals) const {
  constexpr double all = 0.8, none = 1. / 3;
  const Slope first = slope(cell, a, b), last = slope(cell, b, a);
  const double length = from(a, b).norm(), h_a = rise(length, first.sine), h_b = rise(length, last.sine);
  const bool on_a = first.known > all && last.known<none, on_b = last.known> all && first.known < none;
  if (on_a || on_b) return on_a ? h_a : h_b;
  if (diagonals && std::min(first.known, last.known) < all)
    if (const auto h = rise_of_diagonal(shells, cell, a, b)) return *h;
  return harmonic_mean(h_a, h_b);
}

/// Over the middle between two triangles, from the edges of the quadrilateral that they form.
std::optional<double> CurvedEdges::rise_of_diagonal(const std::vector<PetscInt>& shells, PetscInt cell, PetscInt a,
                                                    PetscInt b) const {
  if (shells.size() != 2) return {};
  Vector3d middle = Vector3d::Zero(), normal = Vector3d::Zero();
  for (const PetscInt shell : shells) {
    if (whole_.cells[shell].kind != CellKind::triangle) return {};
    const auto [previous, next] = beside(shell, a);
    const PetscInt corner = previous == b ? next : previous;
    const Vector3d own = facet(shell, a).normal;
    normal += own.dot(facet(cell, a).normal) < 0 ? -own : own;
    middle += (from(a, corner) + from(b, corner)) / 8;
    for (const PetscInt end : {a, b}) middle += offset(end, corner, false) / 2;
  }
  return middle.dot(normal.normalized());
}

Vector3d CurvedEdges::offset(PetscInt a, PetscInt b, bool diagonals) const {
  std::vector<PetscInt> shells;
  std::vector<Vector3d> normals;
  for (const PetscInt shell : at_[a]) {
    const auto [previous, next] = beside(shell, a);
    if (previous != b && next != b) continue;
    shells.push_back(shell);
    normals.push_back((facet(shell, a).normal + facet(shell, b).normal).stableNormalized());
  }
  Matrix3d sum = Matrix3d::Zero();
  Vector3d rises = Vector3d::Zero();
  const auto add = [&](const Vector3d& axis, double h) { sum += axis * axis.transpose(), rises += h * axis; };
  for (std::size_t i = 0; i < shells.size(); ++i) {
    const Vector3d& normal = normals[i];
    const bool rim = std::count_if(normals.begin(), normals.end(),
                                   [&](const Vector3d& other) { return !folded(normal, other); }) == 1;
    if (!rim) add(normal, rise_inside(shells, shells[i], a, b, diagonals));
    for (const Vector3d& axis : {normal, Vector3d(normal.cross(from(a, b)).stableNormalized())})
      if (rim) add(axis, rise_of_rim(shells[i], a, b, axis));
  }
  if (rises.isZero(0)) return rises;
  const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(sum);  // of two elements: 1 +- the cosine of their angle
  const double least = std::pow(std::tan(fold), 2) * eigen.eigenvalues()[2];
  Vector3d offset = Vector3d::Zero();
  for (int i = 0; i < 3; ++i)
    if (const Vector3d axis = eigen.eigenvectors().col(i); eigen.eigenvalues()[i] > least)
      offset += axis.dot(rises) / eigen.eigenvalues()[i] * axis;
  return offset;
}

}  // namespace floe::generate
