#include "floe/generate/halved.h"

#include <algorithm>
#include <map>
#include <optional>

#include "curved_edges.h"

namespace floe::generate {

namespace {

using Eigen::Vector3d;
using Edge = std::array<PetscInt, 2>;  // ascending

Edge edge(PetscInt a, PetscInt b) { return {std::min(a, b), std::max(a, b)}; }

/// A new node and the nodes of the coarse mesh between which it lies: of an edge two, of an element its corners.
struct Middle {
  std::vector<PetscInt> between;
  std::optional<Edge> edge = {};  ///< on which it lies, by its corners
};

/// The shells at an edge of the coarse mesh, and whether it has lines.
struct AtEdge {
  std::vector<PetscInt> shells;
  bool line = false;
};

std::vector<PetscInt> corners_of(const Cell& cell) {
  return {cell.nodes.begin(), cell.nodes.begin() + corner_count(cell.kind)};
}

/// Corners that are the ends of edge i.
Edge ends(const Cell& cell, int i) { return edge(cell.nodes[i], cell.nodes[(i + 1) % corner_count(cell.kind)]); }

int edge_count(CellKind kind) { return is_line(kind) ? 1 : corner_count(kind); }

/// Shape functions of quadrilateral8 at (r, s) in [-1, 1]^2: corners (-1, -1), (1, -1), (1, 1), (-1, 1), then middles.
std::array<double, 8> serendipity(double r, double s) {
  std::array<double, 8> N{};
  const double R[] = {-1, 1, 1, -1, 0, 1, 0, -1}, S[] = {-1, -1, 1, 1, -1, 0, 1, 0};
  for (int i = 0; i < 4; ++i) N[i] = (1 + r * R[i]) * (1 + s * S[i]) * (r * R[i] + s * S[i] - 1) / 4;
  for (int i = 4; i < 8; ++i) N[i] = R[i] == 0 ? (1 - r * r) * (1 + s * S[i]) / 2 : (1 - s * s) * (1 + r * R[i]) / 2;
  return N;
}

/// A link that leaves free what one of two leaves free: all rotations, where that is about two axes.
DependentNode freer(const DependentNode& a, const DependentNode& b) {
  if (!a.spins() || !b.spins()) return a.spins() ? a : b;
  if (a.others == b.others && a.axis == b.axis) return a;
  return {a.node, a.independent_node, {}, true};
}

class Halving {
 public:
  Halving(const RawMesh& whole, const std::vector<Halved>& parts) : whole_(whole), parts_(parts), curves_(whole) {
    fine_ = whole;
    fine_.cells.clear(), fine_.cell_labels.clear();
    find_edges();
    for (std::size_t c = 0; c < whole.cells.size(); ++c) divide(c);
    fine_.node_count = static_cast<PetscInt>(fine_.positions.size());
    fine_.cell_count = static_cast<PetscInt>(fine_.cells.size());
    add_to_places();
  }

  std::vector<DependentNode> links(const std::vector<DependentNode>& coarse) const {
    const auto link = [&](PetscInt node) {  // of a node that moves by itself: to itself
      const auto at = std::lower_bound(coarse.begin(), coarse.end(), node,
                                       [](const DependentNode& one, PetscInt n) { return one.node < n; });
      return at == coarse.end() || at->node != node ? DependentNode{node, node} : *at;
    };
    const auto region = [&](PetscInt node) { return link(node).independent_node; };
    std::map<Edge, std::vector<Edge>> between_regions;  // edges with an end that moves by itself
    for (const auto& [ends, middle] : known_) {
      if (ends[1] >= whole_.node_count) continue;
      const PetscInt a = region(ends[0]), b = region(ends[1]);
      if (a != b && (a == ends[0] || b == ends[1])) between_regions[edge(a, b)].push_back(ends);
    }
    std::vector<DependentNode> all = coarse;
    for (std::size_t i = 0; i < middles_.size(); ++i) {
      const std::vector<PetscInt>& between = middles_[i].between;
      const PetscInt node = whole_.node_count + static_cast<PetscInt>(i);
      const DependentNode first = link(between.front()), second = link(between.back());
      const PetscInt a = first.independent_node, b = second.independent_node;
      DependentNode own = first;
      for (const PetscInt n : between) own = freer(own, link(n));
      own.node = node;
      if (own.spins() && !at_rim(middles_[i])) continue;  // what lies between bends
      if (std::all_of(between.begin(), between.end(), [&](PetscInt n) { return region(n) == a; }))
        all.push_back(own);
      else if (middles_[i].edge && between.front() != a && between.back() != b)
        if (const auto beside = between_regions.find(edge(a, b)); beside != between_regions.end()) {
          own.independent_node = known_.at(nearest(beside->second, x(node)));
          all.push_back(own);
        }
    }
    return all;
  }

  RawMesh take() { return std::move(fine_); }

 private:
  bool stays(const Cell& cell) const {
    if (!has_extent(cell.kind) || parts_.empty()) return !has_extent(cell.kind);
    const Halved part = parts_[static_cast<std::size_t>(cell.part)];
    return part == Halved::none || (part == Halved::along_shells && at_edge_.at(ends(cell, 0)).shells.empty());
  }

  bool at_rim(const Middle& middle) const {
    if (!middle.edge) return false;
    const AtEdge& at = at_edge_.at(*middle.edge);
    return at.shells.size() == 1 && !at.line;
  }

  void find_edges() {
    for (std::size_t c = 0; c < whole_.cells.size(); ++c) {
      const Cell& cell = whole_.cells[c];
      for (int i = 0; has_extent(cell.kind) && i < edge_count(cell.kind); ++i) {
        AtEdge& at = at_edge_[ends(cell, i)];
        if (is_line(cell.kind))
          at.line = true;
        else
          at.shells.push_back(static_cast<PetscInt>(c));
        if (is_quadratic(cell.kind)) known_[ends(cell, i)] = cell.nodes[corner_count(cell.kind) + i];
      }
    }
  }

  Edge nearest(const std::vector<Edge>& edges, const Vector3d& at) const {
    const auto far = [&](const Edge& one) { return (x(known_.at(one)) - at).squaredNorm(); };
    return *std::min_element(edges.begin(), edges.end(), [&](const Edge& a, const Edge& b) { return far(a) < far(b); });
  }

  const Vector3d& x(PetscInt node) const { return fine_.positions[static_cast<std::size_t>(node)]; }

  PetscInt add(const Vector3d& at, Middle middle) {
    fine_.positions.push_back(at);
    fine_.node_labels.push_back(++label_);
    middles_.push_back(std::move(middle));
    return static_cast<PetscInt>(fine_.positions.size()) - 1;
  }

  /// The node at `at`, between two nodes on an edge.
  PetscInt between(PetscInt a, PetscInt b, const Vector3d& at, const Edge& on) {
    const auto [found, fresh] = known_.emplace(edge(a, b), -1);
    if (fresh) found->second = add(at, {{std::min(a, b), std::max(a, b)}, on});
    return found->second;
  }

  /// Of an edge: on the surface that its shells form.
  PetscInt middle(PetscInt a, PetscInt b) {
    const Edge own = edge(a, b);
    if (const auto known = known_.find(own); known != known_.end()) return known->second;
    const Vector3d rise = curves_.offset(own[0], own[1]);
    return between(a, b, (x(a) + x(b)) / 2 + rise, own);
  }

  void emit(std::size_t parent, CellKind kind, std::initializer_list<PetscInt> nodes) {
    Cell cell{kind, no_nodes<PetscInt>(), whole_.cells[parent].part};
    std::copy(nodes.begin(), nodes.end(), cell.nodes.begin());
    fine_.cells.push_back(cell);
    fine_.cell_labels.push_back(whole_.cell_labels[parent]);
  }

  /// Nodes of each edge of an element: its middle and, of second order, those of its halves.
  struct OnEdges {
    std::array<PetscInt, 4> middle{}, before{}, after{};
  };

  OnEdges on_edges(const Cell& cell) {
    OnEdges on;
    for (int i = 0; i < edge_count(cell.kind); ++i) {
      const PetscInt a = cell.nodes[i], b = cell.nodes[(i + 1) % corner_count(cell.kind)];
      const Edge own = edge(a, b);
      const PetscInt m = on.middle[i] = middle(a, b);
      if (!is_quadratic(cell.kind)) continue;
      on.before[i] = between(a, m, 0.375 * x(a) + 0.75 * x(m) - 0.125 * x(b), own);
      on.after[i] = between(m, b, 0.375 * x(b) + 0.75 * x(m) - 0.125 * x(a), own);
    }
    return on;
  }

  void divide(std::size_t c) {
    const Cell& cell = whole_.cells[c];
    if (stays(cell)) {
      fine_.cells.push_back(cell), fine_.cell_labels.push_back(whole_.cell_labels[c]);
      return;
    }
    const OnEdges on = on_edges(cell);
    const auto& [m, before, after] = on;
    const auto& v = cell.nodes;
    switch (cell.kind) {
      case CellKind::line:
        emit(c, cell.kind, {v[0], m[0]}), emit(c, cell.kind, {m[0], v[1]});
        break;
      case CellKind::line3:
        emit(c, cell.kind, {v[0], m[0], before[0]}), emit(c, cell.kind, {m[0], v[1], after[0]});
        break;
      case CellKind::triangle:
        for (int i = 0; i < 3; ++i) emit(c, cell.kind, {v[i], m[i], m[(i + 2) % 3]});
        emit(c, cell.kind, {m[0], m[1], m[2]});
        break;
      case CellKind::quadrilateral: {
        const Vector3d corners = x(v[0]) + x(v[1]) + x(v[2]) + x(v[3]), edges = x(m[0]) + x(m[1]) + x(m[2]) + x(m[3]);
        const PetscInt o = add(edges / 2 - corners / 4, {corners_of(cell)});
        for (int i = 0; i < 4; ++i) emit(c, cell.kind, {v[i], m[i], o, m[(i + 3) % 4]});
        break;
      }
      case CellKind::triangle6:
        divide_triangle(c, on);
        break;
      case CellKind::quadrilateral8:
        divide_quadrilateral(c, on);
        break;
      default:
        break;
    }
  }

  /// Of second order.
  void divide_triangle(std::size_t c, const OnEdges& on) {
    const Cell& cell = whole_.cells[c];
    const auto& [m, before, after] = on;
    const auto& v = cell.nodes;
    std::array<PetscInt, 3> k;  // between the middles of the edges that meet at corner i; opposite lies edge i + 1
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, l = (i + 2) % 3;
      k[i] = add((x(m[i]) + x(m[l])) / 2 + x(m[j]) / 4 - (x(v[j]) + x(v[l])) / 8, {corners_of(cell)});
    }
    for (int i = 0; i < 3; ++i) {
      const int l = (i + 2) % 3;
      emit(c, cell.kind, {v[i], m[i], m[l], before[i], k[i], after[l]});
    }
    emit(c, cell.kind, {m[0], m[1], m[2], k[1], k[2], k[0]});
  }

  /// Of second order.
  void divide_quadrilateral(std::size_t c, const OnEdges& on) {
    const Cell& cell = whole_.cells[c];
    const auto& [m, before, after] = on;
    const auto& v = cell.nodes;
    const auto node_at = [&](double r, double s) {
      const std::array<double, 8> N = serendipity(r, s);
      Vector3d sum = Vector3d::Zero();
      for (int i = 0; i < 8; ++i) sum += N[i] * x(v[i]);
      return add(sum, {corners_of(cell)});
    };
    const PetscInt o = node_at(0, 0);
    const std::array<PetscInt, 4> k{node_at(0, -0.5), node_at(0.5, 0), node_at(0, 0.5), node_at(-0.5, 0)};  // m to o
    for (int i = 0; i < 4; ++i) {
      const int l = (i + 3) % 4;
      emit(c, cell.kind, {v[i], m[i], o, m[l], before[i], k[i], k[l], after[l]});
    }
  }

  void add_to_places() {
    std::vector<char> on_boundary(whole_.positions.size(), 0);
    for (const auto& [nodes, at] : at_edge_)
      if (at.shells.size() == 1) on_boundary[nodes[0]] = on_boundary[nodes[1]] = 1;
    for (std::size_t place = 0; place < fine_.places.size(); ++place) {
      if (fine_.place_weights.contains(fine_.places[place])) continue;
      std::vector<PetscInt>& nodes = fine_.place_nodes[place];
      std::vector<char> in(whole_.positions.size(), 0);
      for (const PetscInt node : nodes) in[node] = 1;
      const bool rim = std::all_of(nodes.begin(), nodes.end(), [&](PetscInt node) { return on_boundary[node] != 0; });
      for (std::size_t i = 0; i < middles_.size(); ++i) {
        const Middle& middle = middles_[i];
        if (!std::all_of(middle.between.begin(), middle.between.end(), [&](PetscInt node) { return in[node] != 0; }))
          continue;
        if (!middle.edge || along(at_edge_.at(*middle.edge), in, rim))
          nodes.push_back(whole_.node_count + static_cast<PetscInt>(i));
      }
    }
  }

  /// Whether an edge whose ends a place has lies along it or in it: not a chord of a boundary, next to an element at a
  /// corner.
  bool along(const AtEdge& at, const std::vector<char>& in, bool rim) const {
    if (at.line || at.shells.size() < 2) return true;
    const auto covered = [&](PetscInt shell) {
      const std::vector<PetscInt> corners = corners_of(whole_.cells[shell]);
      return std::all_of(corners.begin(), corners.end(), [&](PetscInt node) { return in[node] != 0; });
    };
    return !rim || std::all_of(at.shells.begin(), at.shells.end(), covered);
  }

  const RawMesh& whole_;
  const std::vector<Halved>& parts_;
  const CurvedEdges curves_;
  RawMesh fine_;
  std::map<Edge, AtEdge> at_edge_;  // of the coarse mesh, by corners
  std::map<Edge, PetscInt> known_;  // nodes between two others
  std::vector<Middle> middles_;     // of each new node
  long long label_ = first_label(whole_);

  static long long first_label(const RawMesh& mesh) {
    const auto last = std::max_element(mesh.node_labels.begin(), mesh.node_labels.end());
    return last == mesh.node_labels.end() ? 0 : *last;
  }
};

}  // namespace

RawMesh halved(const RawMesh& whole, std::vector<DependentNode>& links, const std::vector<Halved>& parts) {
  Halving halving(whole, parts);
  links = halving.links(links);
  return halving.take();
}

}  // namespace floe::generate
