#include "curved_edges.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace floe::generate {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

bool folded(const Vector3d& one, const Vector3d& other) { return one.cross(other).norm() >= std::sin(2 * fold); }

constexpr double round_off = 1e-8;

/// Of an arc over the middle of its chord; none where the angle between them is round-off.
double rise(double chord, double sine) {
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

/// Whether two elements at an edge from `node` are one surface there: not folded, not on the same side of the edge.
bool CurvedEdges::go_on(PetscInt cell, PetscInt other, PetscInt node, PetscInt end) const {
  const Vector3d edge = from(node, end).stableNormalized();
  const auto away = [&](PetscInt one) {
    const auto [previous, next] = beside(one, node);
    const Vector3d side = from(node, previous == end ? next : previous);
    return Vector3d(side - edge.dot(side) * edge);
  };
  return away(cell).dot(away(other)) < 0 && !folded(facet(cell, node).normal, facet(other, node).normal);
}

/// The elements at a node that an element goes on to from edge to edge, without one that is folded from it.
std::vector<CurvedEdges::Corner> CurvedEdges::surface(PetscInt cell, PetscInt node) const {
  std::vector<Corner> corners{{cell, facet(cell, node)}};
  for (std::size_t i = 0; i < corners.size(); ++i)
    for (const PetscInt end : beside(corners[i].cell, node))
      for (const PetscInt other : at_[node]) {
        const auto [previous, next] = beside(other, node);
        const bool seen =
            std::any_of(corners.begin(), corners.end(), [&](const auto& one) { return one.cell == other; });
        if (seen || (previous != end && next != end) || !go_on(corners[i].cell, other, node, end)) continue;
        if (const FacetCorner one = facet(other, node); !folded(one.normal, corners[0].facet.normal))
          corners.push_back({other, one});
      }
  return corners;
}

Vector3d CurvedEdges::middle(PetscInt cell) const {
  const int n = corner_count(whole_.cells[cell].kind);
  Vector3d sum = Vector3d::Zero();
  for (int i = 0; i < n; ++i) sum += whole_.positions[whole_.cells[cell].nodes[i]];
  return sum / n;
}

CurvedEdges::Normal CurvedEdges::normal(PetscInt cell, PetscInt node) const {
  Matrix3d sum = Matrix3d::Zero();
  Vector3d ahead = Vector3d::Zero();
  double angles = 0;
  for (const Corner& one : surface(cell, node)) {
    sum += one.facet.weighted();
    angles += one.facet.angle;
    ahead += one.facet.angle * (middle(one.cell) - whole_.positions[node]);
  }
  const Vector3d axis = surface_normal(sum), at = ahead / angles;
  return {axis.dot(facet(cell, node).normal) < 0 ? Vector3d(-axis) : axis, at - axis.dot(at) * axis};
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
  if (!(back.dot(on) > std::cos(2 * fold) * back.norm() * on.norm())) return {};
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
  constexpr double least = 0.5;
  const Vector3d chord = from(a, b), across = (facet(cell, a).normal + facet(cell, b).normal).stableNormalized();
  const Normal first = normal(cell, a), last = normal(cell, b);
  const auto known = [&](const Normal& end, const Normal& other, const Vector3d& d) {
    Vector3d bend = other.axis - across.dot(other.axis) * across;
    if (std::abs(bend.dot(d)) < 0.1 * bend.norm() * d.norm() || bend.norm() < round_off) bend = d;
    return 1 - 2 * end.at.dot(bend) / d.dot(bend);
  };
  const auto height = [&](const Normal& end, const Vector3d& d, double share) {
    const double sine = -d.dot(end.axis) / d.norm();
    return rise(d.norm(), share > least && std::abs(std::log(share)) > std::log(4. / 3) ? sine / share : sine);
  };
  const double at_a = known(first, last, chord), at_b = known(last, first, -chord);
  const double h_a = height(first, chord, at_a), h_b = height(last, -chord, at_b);
  if (at_a > least && at_b > least) return harmonic_mean(h_a, h_b);
  if (at_a > least || at_b > least) return at_a > least ? h_a : h_b;
  if (diagonals && (h_a != 0 || h_b != 0))
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

/// Of an element across one of its edges.
double CurvedEdges::width(PetscInt cell, PetscInt a, PetscInt b) const {
  const Vector3d edge = from(a, b).stableNormalized();
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < corner_count(whole_.cells[cell].kind); ++i)
    if (const PetscInt node = whole_.cells[cell].nodes[i]; node != a && node != b)
      least = std::min(least, edge.cross(from(a, node)).norm());
  return least;
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
    const auto goes_on = [&](PetscInt other) { return other != shells[i] && go_on(shells[i], other, a, b); };
    const bool rim = std::none_of(shells.begin(), shells.end(), goes_on);
    add(normals[i], rim ? rise_of_rim(shells[i], a, b, normals[i]) : rise_inside(shells, shells[i], a, b, diagonals));
  }
  if (shells.size() == 1) {
    const Vector3d axis = normals[0].cross(from(a, b)).stableNormalized();
    const double most = width(shells[0], a, b) / 4, h = rise_of_rim(shells[0], a, b, axis);
    add(axis, std::clamp(h, -most, most));
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
