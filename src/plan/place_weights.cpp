#include "floe/plan/place_weights.h"

#include <algorithm>
#include <cmath>

#include "floe/error.h"
#include "floe/fem/pressure.h"
#include "floe/fem/quadratic_shell.h"
#include "floe/math/rotation.h"
#include "floe/mesh/exchange.h"

namespace floe::plan {
namespace {

/// Of each corner of the element: where it is among the place's nodes; -1: not there.
class Set {
 public:
  Set(const fem::Mesh& mesh, const std::vector<PetscInt>& nodes) : mesh_(mesh) {
    for (std::size_t i = 0; i < nodes.size(); ++i) index_.emplace_back(nodes[i], static_cast<int>(i));
    std::sort(index_.begin(), index_.end());
  }
  int of(int local) const {
    const PetscInt node = mesh_.global_node(local);
    const auto at = std::lower_bound(index_.begin(), index_.end(), std::pair(node, -1));
    return at != index_.end() && at->first == node ? at->second : -1;
  }
  bool contains(const fem::Mesh::Cell& cell) const {
    const auto corners = cell.places();
    return std::all_of(corners.begin(), corners.end(), [&](int corner) { return of(corner) >= 0; });
  }
  std::size_t size() const { return index_.size(); }

 private:
  const fem::Mesh& mesh_;
  std::vector<std::pair<PetscInt, int>> index_;  // ascending
};

using fem::is_shell;

using Weights = std::vector<reduction::WeightedNode>;

Weights zero(std::size_t count) { return Weights(count, {0, 0}); }

bool all_positive(const Weights& weights) {
  return std::all_of(weights.begin(), weights.end(), [](const auto& at) { return at.weight > 0; });
}

/// @param shape  of each node of the place, interpolated between them
Weights area_weights(const fem::Mesh& mesh, const Set& set, const std::vector<double>& shape) {
  std::vector<double> areas(set.size(), 0);
  const auto add = [&](const std::array<int, 3>& corners, double part) {
    const Eigen::Vector3d &a = mesh.positions[corners[0]], &b = mesh.positions[corners[1]],
                          &c = mesh.positions[corners[2]];
    double sum = 0;
    for (int corner : corners) sum += shape[set.of(corner)];
    for (int corner : corners)  // int N_i s dA = A / 12 (s_i + sum s)
      areas[set.of(corner)] += part * (b - a).cross(c - a).norm() / 6 * ((shape[set.of(corner)] + sum) / 4);
  };
  for (const fem::Mesh::Cell& cell : mesh.cells) {
    if (!is_shell(cell) || !set.contains(cell)) continue;
    const auto& k = cell.place;
    if (mesh::is_quadratic(cell.kind)) {
      std::vector<Eigen::Vector3d> x;
      for (const int node : cell.places()) x.push_back(mesh.positions[node]);
      const std::vector<fem::NodeShare> shares = fem::quadratic_shell_shares(x);
      for (std::size_t i = 0; i < shares.size(); ++i) areas[set.of(k[i])] += shares[i].area * shape[set.of(k[i])];
    } else if (cell.kind == fem::CellKind::triangle)
      add({k[0], k[1], k[2]}, 1);
    else
      for (const std::array<int, 3>& half : {std::array{k[0], k[1], k[2]}, std::array{k[0], k[2], k[3]},
                                             std::array{k[1], k[2], k[3]}, std::array{k[1], k[3], k[0]}})
        add(half, 0.5);
  }
  MPI_Allreduce(MPI_IN_PLACE, areas.data(), static_cast<int>(areas.size()), MPI_DOUBLE, MPI_SUM, mesh.comm);
  Weights weights = zero(set.size());
  for (std::size_t i = 0; i < areas.size(); ++i) weights[i].weight = areas[i];
  return weights;
}

/// An edge of an element between two nodes of the place, by their indices there, first < second.
struct Edge {
  int first, second;
  double along[3];               // from the first to the second
  double across[3];              // of a shell: in its plane, unit vector
  double alpha;                  // of a shell
  int beam, inside;              // of a beam; of a shell element that belongs to the place as a whole
  int middle = -1;               // index of the node between, of elements of second order
  double shares[3] = {0, 0, 0};  // integrals of its quadratic functions: of the first, the second, the one between
};

/// Nodes `a`, `b` and `between` of an element of second order.
void set_curve(const fem::Mesh& mesh, const Set& set, int a, int b, int between, Edge& edge) {
  if (set.of(a) > set.of(b)) std::swap(a, b);
  edge.middle = set.of(between);
  const Eigen::Vector3d X[3] = {mesh.positions[a], mesh.positions[b], mesh.positions[between]};
  const double end = std::sqrt(0.6);
  for (const auto& [r, weight] : {std::pair(-end, 5. / 9), {0., 8. / 9}, {end, 5. / 9}}) {
    const double N[3] = {r * (r - 1) / 2, r * (r + 1) / 2, 1 - r * r};
    const double length = ((r - 0.5) * X[0] + (r + 0.5) * X[1] - 2 * r * X[2]).norm();
    for (int i = 0; i < 3; ++i) edge.shares[i] += weight * length * N[i];
  }
}

Edge edge_of(const fem::Structure& structure, const fem::Mesh::Cell& cell, const Set& set, int a, int b) {
  if (set.of(a) > set.of(b)) std::swap(a, b);
  const auto at = [&](int corner) -> const Eigen::Vector3d& { return structure.mesh.positions[corner]; };
  const Eigen::Vector3d along = at(b) - at(a);
  Eigen::Vector3d across = Eigen::Vector3d::Zero();
  double alpha = 1;
  if (is_shell(cell)) {
    const auto& k = cell.place;
    const auto& section = std::get<fem::ShellSection>(structure.sections[cell.part]);
    across = (at(k[1]) - at(k[0])).cross(at(k[2]) - at(k[0])).cross(along).normalized();
    alpha = fem::on_curved_surface(section, cell.rise).drilling;
  }
  return {set.of(a),
          set.of(b),
          {along.x(), along.y(), along.z()},
          {across.x(), across.y(), across.z()},
          alpha,
          is_shell(cell) ? 0 : 1,
          is_shell(cell) && set.contains(cell) ? 1 : 0};
}

/// Of all ranks, on every rank, edges of one pair of nodes one after the other. Collective.
std::vector<Edge> edges_within(const fem::Structure& structure, const Set& set) {
  const fem::Mesh& mesh = structure.mesh;
  std::vector<Edge> mine, copies;
  for (const fem::Mesh::Cell& cell : mesh.cells) {
    const auto corners = cell.corners();
    if (corners.size() < 2) continue;
    for (std::size_t i = 0; i < (is_shell(cell) ? corners.size() : 1); ++i) {
      const int a = corners[i], b = corners[(i + 1) % corners.size()];
      const int between = mesh::is_quadratic(cell.kind) ? cell.places()[corners.size() + i] : -1;
      if (set.of(a) < 0 || set.of(b) < 0 || (between >= 0 && set.of(between) < 0)) continue;
      mine.push_back(edge_of(structure, cell, set, a, b));
      if (between >= 0) set_curve(mesh, set, a, b, between, mine.back());
    }
  }
  int ranks = 1;
  MPI_Comm_size(mesh.comm, &ranks);
  for (int r = 0; r < ranks; ++r) copies.insert(copies.end(), mine.begin(), mine.end());
  std::vector<Edge> all =
      mesh::exchange(mesh.comm, copies, std::vector<int>(ranks, static_cast<int>(mine.size()))).values;
  std::sort(all.begin(), all.end(),
            [](const Edge& a, const Edge& b) { return std::pair(a.first, a.second) < std::pair(b.first, b.second); });
  return all;
}

/// What the rotation of the first end adds to the integral of the displacements, l^2 / 12 A (theta x s), A the mean
/// over the elements that have the edge, alpha in the plane of a shell; of the second end the negative.
Eigen::Matrix3d arm_of(std::vector<Edge>::const_iterator begin, std::vector<Edge>::const_iterator end) {
  const Eigen::Vector3d along(begin->along[0], begin->along[1], begin->along[2]);
  Eigen::Matrix3d A = Eigen::Matrix3d::Identity();
  for (auto edge = begin; edge != end; ++edge) {
    const Eigen::Vector3d across(edge->across[0], edge->across[1], edge->across[2]);
    A += (edge->alpha - 1) / static_cast<double>(end - begin) * across * across.transpose();
  }
  return -along.norm() / 12 * A * math::skew(along);
}

/// @param shape  as of area_weights: l / 6 (2 s_i + s_j), and arms by its mean, so that resultant and moment are exact
Weights edge_weights(const fem::Structure& structure, const Set& set, const std::vector<double>& shape) {
  Weights weights = zero(set.size());
  const std::vector<Edge> edges = edges_within(structure, set);
  for (auto begin = edges.begin(); begin != edges.end();) {
    const auto end = std::find_if(begin, edges.end(), [&](const Edge& other) {
      return std::pair(other.first, other.second) != std::pair(begin->first, begin->second);
    });
    const auto shells = std::count_if(begin, end, [](const Edge& edge) { return edge.beam == 0; });
    const bool inside = std::any_of(begin, end, [](const Edge& edge) { return edge.inside != 0; });
    if (shells < end - begin || !inside || shells == 1) {
      const double s = shape[begin->first], t = shape[begin->second];
      if (begin->middle >= 0) {
        const double m = shape[begin->middle];
        weights[begin->first].weight += begin->shares[0] * ((4 * s - t + 2 * m) / 5);
        weights[begin->second].weight += begin->shares[1] * ((4 * t - s + 2 * m) / 5);
        weights[begin->middle].weight += begin->shares[2] * ((2 * s + 2 * t + 16 * m) / 20);
        begin = end;
        continue;
      }
      const double half = Eigen::Vector3d(begin->along[0], begin->along[1], begin->along[2]).norm() / 2;
      const Eigen::Matrix3d arm = arm_of(begin, end);
      weights[begin->first].weight += half * ((2 * s + t) / 3);
      weights[begin->second].weight += half * ((s + 2 * t) / 3);
      weights[begin->first].arm += (s + t) / 2 * arm, weights[begin->second].arm -= (s + t) / 2 * arm;
    }
    begin = end;
  }
  return weights;
}

}  // namespace

Weights place_weights(const fem::Structure& structure, const std::vector<PetscInt>& nodes, PlaceMeasure* measure) {
  const fem::Mesh& mesh = structure.mesh;
  Weights weights(nodes.size(), {0, 1});
  PlaceMeasure found_measure;
  if (nodes.size() > 1) {
    const Set set(mesh, nodes);
    const std::vector<double> one(nodes.size(), 1);
    if (Weights found = area_weights(mesh, set, one); all_positive(found))
      weights = std::move(found), found_measure.of = PlaceMeasure::Of::areas;
    else if (found = edge_weights(structure, set, one); all_positive(found))
      weights = std::move(found), found_measure.of = PlaceMeasure::Of::edges;
  }
  double sum = 0;
  for (const reduction::WeightedNode& at : weights) sum += at.weight;
  found_measure.size = sum;
  if (measure) *measure = found_measure;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    weights[i].node = nodes[i];
    weights[i].weight /= sum;
    weights[i].arm /= sum;
  }
  set_rotation(structure, weights);
  return weights;
}

Weights weights_of(const fem::Structure& structure, const mesh::NodeSet& place) {
  if (place.weights.empty()) return place_weights(structure, place.nodes);
  if (place.weights.size() != place.nodes.size()) throw RunError("weights and nodes of a place differ in number");
  double sum = 0;
  for (const double weight : place.weights) sum += weight;
  Weights weights;
  for (std::size_t i = 0; i < place.nodes.size(); ++i) weights.push_back({place.nodes[i], place.weights[i] / sum});
  set_rotation(structure, weights, RotationBy::displacements);
  return weights;
}

std::vector<reduction::WeightedNode> shaped_weights(const fem::Structure& structure, const std::vector<PetscInt>& nodes,
                                                    PlaceMeasure::Of of, const std::vector<double>& shape) {
  const Set set(structure.mesh, nodes);
  Weights weights =
      of == PlaceMeasure::Of::areas ? area_weights(structure.mesh, set, shape) : edge_weights(structure, set, shape);
  for (std::size_t i = 0; i < nodes.size(); ++i) weights[i].node = nodes[i];
  return weights;
}

}  // namespace floe::plan
