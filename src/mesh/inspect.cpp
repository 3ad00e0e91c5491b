#include "floe/mesh/inspect.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "components.h"
#include "faults.h"
#include "floe/mesh/exchange.h"
#include "floe/mesh/labels.h"
#include "floe/petsc/all_ranks.h"

namespace floe::mesh {
namespace {

/// Positions of the nodes of this rank's cells.
class Corners {
 public:
  explicit Corners(const RawMesh& mesh) : nodes_(keys(mesh)) {
    struct Point {
      double x[3];
    };
    const auto starts = starts_of(mesh.comm, static_cast<PetscInt>(mesh.positions.size()));
    const auto points = ask<Point>(
        mesh.comm, nodes_.keys(), [&](long long node) { return owner_of(starts, static_cast<PetscInt>(node)); },
        [&](long long node) {
          const auto& p = mesh.positions[node - mesh.first_node];
          return Point{{p[0], p[1], p[2]}};
        });
    for (const auto& point : points) positions_.emplace_back(point.x[0], point.x[1], point.x[2]);
  }
  const Eigen::Vector3d& operator[](PetscInt node) const { return positions_[nodes_.position(node)]; }

 private:
  static std::vector<long long> keys(const RawMesh& mesh) {
    std::vector<long long> nodes;
    for (const auto& cell : mesh.cells)
      nodes.insert(nodes.end(), cell.nodes.begin(), cell.nodes.begin() + node_count(cell.kind));
    return nodes;
  }
  Translation nodes_;
  std::vector<Eigen::Vector3d> positions_;
};

std::string element(long long label) { return "element " + std::to_string(label); }

std::string shape_fault(const Cell& cell, const Corners& corners) {
  constexpr double flat = 1e-12;
  const int all = node_count(cell.kind), n = corner_count(cell.kind);
  if (cell.kind == CellKind::point) return "";
  if (cell.kind == CellKind::spring) return cell.nodes[0] == cell.nodes[1] ? " has the same node twice" : "";
  for (int i = 0; i < all; ++i)
    for (int j = 0; j < i; ++j)
      if (cell.nodes[i] == cell.nodes[j]) return " has the same node twice";
  const auto edge = [&](int i) {
    return Eigen::Vector3d(corners[cell.nodes[(i + 1) % n]] - corners[cell.nodes[i % n]]);
  };
  double longest = 0;
  for (int i = 0; i < n; ++i) longest = std::max(longest, edge(i).norm());
  if (is_line(cell.kind)) return longest > 0 ? "" : " has no length";
  if (n == 3) return edge(0).cross(edge(1)).norm() / 2 > flat * longest * longest ? "" : " has no area";
  const Eigen::Vector3d normal = (edge(0) + edge(1)).cross(edge(1) + edge(2));
  if (!(normal.norm() / 2 > flat * longest * longest)) return " has no area";
  for (int i = 0; i < n; ++i)
    if (edge(i).cross(edge(i + 1)).dot(normal) < 0) return " is folded: not convex";
  return "";
}

void check_shapes(const RawMesh& mesh, Faults& faults) {
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    if (!mesh.positions[i].allFinite())
      faults.add({0, mesh.first_node + static_cast<long long>(i)},
                 "node " + std::to_string(mesh.node_labels[i]) + " has coordinates that are not finite");
  const Corners corners(mesh);
  for (std::size_t i = 0; i < mesh.cells.size(); ++i) {
    bool finite = true;
    for (int k = 0; k < node_count(mesh.cells[i].kind); ++k)
      finite = finite && corners[mesh.cells[i].nodes[k]].allFinite();
    const std::string fault = finite ? shape_fault(mesh.cells[i], corners) : "";
    if (!fault.empty())
      faults.add({1, mesh.first_cell + static_cast<long long>(i)}, element(mesh.cell_labels[i]) + fault);
  }
}

struct Key {
  std::array<PetscInt, most_nodes> nodes;  // ascending, -1 first
  PetscInt cell;
  long long label;
  bool line;
  auto operator<=>(const Key&) const = default;
};

/// Elements of the same nodes: those of beams go to `beams` where there is one, as pairs of labels, all others are
/// faults.
void check_duplicates(const RawMesh& mesh, Faults& faults, std::vector<std::array<long long, 2>>* beams) {
  int ranks = 1;
  MPI_Comm_size(mesh.comm, &ranks);
  std::vector<Key> keys;
  for (std::size_t i = 0; i < mesh.cells.size(); ++i) {
    if (!has_extent(mesh.cells[i].kind)) continue;  // masses on one node add up, springs between two likewise
    Key key{no_nodes<PetscInt>(), mesh.first_cell + static_cast<PetscInt>(i), mesh.cell_labels[i],
            is_line(mesh.cells[i].kind)};
    std::copy_n(mesh.cells[i].nodes.begin(), node_count(mesh.cells[i].kind), key.nodes.begin());
    std::sort(key.nodes.begin(), key.nodes.end());
    keys.push_back(key);
  }
  auto mine = scatter(mesh.comm, keys, [&](const Key& key) { return key.nodes.back() % ranks; }).values;
  std::sort(mine.begin(), mine.end());
  for (std::size_t i = 1; i < mine.size(); ++i) {
    if (mine[i].nodes != mine[i - 1].nodes) continue;
    if (beams && mine[i].line)
      beams->push_back({mine[i].label, mine[i - 1].label});
    else
      faults.add({1, mine[i].cell}, element(mine[i].label) + " has the nodes of " + element(mine[i - 1].label));
  }
}

std::string beams_side_by_side(const RawMesh& mesh, const std::vector<std::array<long long, 2>>& mine) {
  const auto all = petsc::of_all_ranks(mesh.comm, mine);
  if (all.empty()) return "";
  const auto [one, other] = *std::min_element(all.begin(), all.end());
  return mesh.source + ": " + std::to_string(all.size()) +
         (all.size() == 1 ? " beam has the nodes of another one" : " beams have the nodes of others") +
         ", for example " + element(one) + " those of " + element(other) + ": all of them count";
}

struct Edge {
  PetscInt low, high;
  bool rising;
  long long label;
};

// Edges between exactly two shells that run along them in the same direction; the least pair of labels goes to
// `sample`.
PetscInt opposite_edges(const RawMesh& mesh, std::array<long long, 2>& sample) {
  int ranks = 1;
  MPI_Comm_size(mesh.comm, &ranks);
  std::vector<Edge> edges;
  for (std::size_t i = 0; i < mesh.cells.size(); ++i) {
    const auto& cell = mesh.cells[i];
    const int n = corner_count(cell.kind);
    for (int k = 0; n > 2 && k < n; ++k) {
      const PetscInt a = cell.nodes[k], b = cell.nodes[(k + 1) % n];
      edges.push_back({std::min(a, b), std::max(a, b), a < b, mesh.cell_labels[i]});
    }
  }
  auto mine = scatter(mesh.comm, edges, [&](const Edge& edge) { return edge.low % ranks; }).values;
  const auto order = [](const Edge& e) { return std::tuple(e.low, e.high, e.label); };
  std::sort(mine.begin(), mine.end(), [&](const Edge& a, const Edge& b) { return order(a) < order(b); });
  const auto same = [&](std::size_t i, std::size_t j) {
    return j < mine.size() && mine[i].low == mine[j].low && mine[i].high == mine[j].high;
  };
  PetscInt count = 0, all = 0;
  constexpr long long none = std::numeric_limits<long long>::max();
  std::array<long long, 2> least{none, none};
  for (std::size_t i = 0, end = 0; i < mine.size(); i = end) {
    for (end = i + 1; same(i, end);) ++end;
    if (end - i != 2 || mine[i].rising != mine[i + 1].rising) continue;
    ++count;
    least = std::min(least, {mine[i].label, mine[i + 1].label});
  }
  MPI_Allreduce(&count, &all, 1, MPIU_INT, MPI_SUM, mesh.comm);
  std::vector<long long> samples(2 * static_cast<std::size_t>(ranks));
  MPI_Allgather(least.data(), 2, MPI_LONG_LONG, samples.data(), 2, MPI_LONG_LONG, mesh.comm);
  sample = {none, none};
  for (std::size_t r = 0; r < samples.size(); r += 2) sample = std::min(sample, {samples[r], samples[r + 1]});
  return all;
}

}  // namespace

Inspection inspect(const RawMesh& mesh, const std::vector<std::array<PetscInt, 2>>& connections, bool side_by_side) {
  Inspection result;
  Faults faults;
  std::vector<std::array<long long, 2>> beams;
  check_shapes(mesh, faults);
  check_duplicates(mesh, faults, side_by_side ? &beams : nullptr);
  if (const std::string notice = beams_side_by_side(mesh, beams); !notice.empty()) result.notices.push_back(notice);
  result.faults = faults.texts_together(mesh.comm);
  for (auto& fault : result.faults) fault.insert(0, mesh.source + ": ");
  find_components(mesh, connections, result);
  if (result.component_count > 1) {
    std::string text = mesh.source + ": the mesh is in " + std::to_string(result.component_count) + " pieces:";
    for (const auto& piece : result.components)
      text += (text.back() == ':' ? " " : ", ") + std::to_string(piece.nodes) + " nodes with node " +
              std::to_string(piece.label);
    result.notices.push_back(text +
                             (result.component_count > static_cast<PetscInt>(result.components.size()) ? ", ..." : ""));
  }
  std::array<long long, 2> sample;
  result.opposite_edges = opposite_edges(mesh, sample);
  if (result.opposite_edges > 0)
    result.notices.push_back(mesh.source + ": shells of opposite orientation meet at " +
                             std::to_string(result.opposite_edges) + " edges, for example " + element(sample[0]) +
                             " and " + element(sample[1]));
  return result;
}

}  // namespace floe::mesh
