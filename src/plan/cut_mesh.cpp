#include "cut_mesh.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "floe/error.h"
#include "floe/math/disjoint_sets.h"
#include "floe/math/nearest.h"
#include "floe/scene/places.h"

namespace floe::plan {
namespace {

using Eigen::Vector3d;
using mesh::Cell;
using mesh::RawMesh;

Vector3d vector(const Point& p) { return {p[0], p[1], p[2]}; }

std::string frames_of(const Body& body) { return body.where.text() + ".frames"; }

bool spreads(const Cell& cell) { return mesh::has_extent(cell.kind); }

/// Coordinates of the nodes along the direction in which the mesh is longest.
std::vector<double> stations(const Body& body, const RawMesh& mesh) {
  std::vector<Vector3d> directions{Vector3d::UnitX(), Vector3d::UnitY(), Vector3d::UnitZ()};
  if (body.mesh.plate)
    directions = {vector(body.mesh.plate->along).normalized(), vector(body.mesh.plate->across).normalized()};
  std::vector<double> longest;
  double extent = 0;
  for (const Vector3d& direction : directions) {
    std::vector<double> s;
    for (const Vector3d& x : mesh.positions) s.push_back(direction.dot(x));
    const auto [least, greatest] = std::minmax_element(s.begin(), s.end());
    const double begin = *least, own = *greatest - begin;
    if (!(own > extent * (1 + 1e-9))) continue;
    extent = own;
    for (double& at : s) at -= begin;
    longest = std::move(s);
  }
  const double length = *std::max_element(longest.begin(), longest.end());
  for (double& at : longest) at /= length;
  return longest;
}

/// Stations of the planes: of the corners of elements, those nearest to equal divisions.
std::vector<double> planes(const Body& body, const RawMesh& mesh, const std::vector<double>& s) {
  std::vector<double> at;
  for (const Cell& cell : mesh.cells)
    for (int i = 0; spreads(cell) && i < mesh::corner_count(cell.kind); ++i) at.push_back(s[cell.nodes[i]]);
  std::sort(at.begin(), at.end());
  at.erase(std::unique(at.begin(), at.end(), [](double a, double b) { return b - a < 1e-9; }), at.end());
  std::vector<double> planes;
  for (int k = 1; k < body.frames; ++k) {
    const double ideal = static_cast<double>(k) / body.frames;
    const auto near = [&](double a, double b) { return std::abs(a - ideal) < std::abs(b - ideal) - 1e-9; };
    planes.push_back(*std::min_element(at.begin(), at.end(), near));
  }
  for (std::size_t k = 0; k < planes.size(); ++k)
    if (planes[k] - (k == 0 ? 0 : planes[k - 1]) < 1e-9 || 1 - planes[k] < 1e-9)
      throw InputError(
          fmt::format("{}: is {}, but the mesh of body {} has only {} planes of nodes across its longest "
                      "extent; expected at most {}",
                      frames_of(body), body.frames, body.name, at.size(), at.size() - 1));
  return planes;
}

/// Of each element with an extent its piece, numbered by slices and in each by the first element; -1: a point mass or
/// spring.
std::vector<int> pieces_of_elements(const Body& body, const WholeMesh& whole) {
  const RawMesh& mesh = whole.mesh;
  const std::vector<double> s = stations(body, mesh), cuts = planes(body, mesh, s);
  std::vector<int> slice(mesh.cells.size(), -1);
  for (std::size_t c = 0; c < slice.size(); ++c) {
    const Cell& cell = mesh.cells[c];
    if (!spreads(cell)) continue;
    double mean = 0;
    for (int i = 0; i < mesh::corner_count(cell.kind); ++i) mean += s[cell.nodes[i]] / mesh::corner_count(cell.kind);
    slice[c] = static_cast<int>(std::upper_bound(cuts.begin(), cuts.end(), mean) - cuts.begin());
  }
  std::vector<int> independent_node(mesh.positions.size());  // a rigid region is one node
  std::iota(independent_node.begin(), independent_node.end(), 0);
  for (const mesh::DependentNode& link : whole.links)
    independent_node[link.node] = static_cast<int>(link.independent_node);
  math::DisjointSets<int> sets(mesh.cells.size());
  std::map<std::pair<int, int>, int> first;  // of a slice and a node
  for (std::size_t c = 0; c < slice.size(); ++c)
    for (int i = 0; slice[c] >= 0 && i < mesh::node_count(mesh.cells[c].kind); ++i) {
      const int node = independent_node[mesh.cells[c].nodes[i]];
      const auto [at, fresh] = first.emplace(std::pair(slice[c], node), static_cast<int>(c));
      if (!fresh) sets.join(at->second, static_cast<int>(c));
    }
  for (const Cell& cell : mesh.cells)
    for (int k = 0; cell.kind == mesh::CellKind::spring && k < body.frames; ++k) {
      const auto a = first.find({k, independent_node[cell.nodes[0]]}),
                 b = first.find({k, independent_node[cell.nodes[1]]});
      if (a != first.end() && b != first.end()) sets.join(a->second, b->second);
    }
  std::map<std::pair<int, int>, int> number;  // of a slice and the first element
  for (std::size_t c = 0; c < slice.size(); ++c)
    if (slice[c] >= 0) number.emplace(std::pair(slice[c], sets.root(static_cast<int>(c))), 0);
  int next = 0;
  for (auto& [key, piece] : number) piece = next++;
  std::vector<int> pieces(slice.size(), -1);
  for (std::size_t c = 0; c < slice.size(); ++c)
    if (slice[c] >= 0) pieces[c] = number.at({slice[c], sets.root(static_cast<int>(c))});
  return pieces;
}

std::vector<std::vector<int>> pieces_of_nodes(const RawMesh& mesh, const std::vector<int>& of_elements) {
  std::vector<std::vector<int>> all(mesh.positions.size());
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    for (int i = 0; of_elements[c] >= 0 && i < mesh::node_count(mesh.cells[c].kind); ++i)
      all[mesh.cells[c].nodes[i]].push_back(of_elements[c]);
  for (std::vector<int>& pieces : all) {
    std::sort(pieces.begin(), pieces.end());
    pieces.erase(std::unique(pieces.begin(), pieces.end()), pieces.end());
  }
  return all;
}

/// Nodes that nothing but springs joins to the rest belong to a piece of the other end.
void add_nodes_of_springs(const RawMesh& mesh, std::vector<std::vector<int>>& of_nodes) {
  for (bool changed = true; changed;) {
    changed = false;
    for (const Cell& cell : mesh.cells) {
      if (cell.kind != mesh::CellKind::spring) continue;
      std::vector<int>&a = of_nodes[cell.nodes[0]], &b = of_nodes[cell.nodes[1]];
      if (a.empty() == b.empty()) continue;
      (a.empty() ? a : b) = {(a.empty() ? b : a).front()};
      changed = true;
    }
  }
}

std::vector<int> common(const std::vector<int>& a, const std::vector<int>& b) {
  std::vector<int> both;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
  return both;
}

/// Each rigid region belongs to the first piece that has all of its nodes with elements; those without have its piece.
/// @return  of each link its piece
std::vector<int> pieces_of_links(const Body& body, const WholeMesh& whole, std::vector<std::vector<int>>& of_nodes) {
  std::map<PetscInt, std::optional<std::vector<int>>> shared;  // by independent node; none: no node with elements
  const auto restrict_to = [](std::optional<std::vector<int>>& pieces, const std::vector<int>& of_node) {
    if (!of_node.empty()) pieces = pieces ? common(*pieces, of_node) : of_node;
  };
  for (const mesh::DependentNode& link : whole.links) {
    const auto [at, fresh] = shared.try_emplace(link.independent_node);
    if (fresh) restrict_to(at->second, of_nodes[link.independent_node]);
    restrict_to(at->second, of_nodes[link.node]);
  }
  for (auto& [independent_node, pieces] : shared) {
    if (!pieces) pieces = {0};
    if (pieces->empty())
      throw InputError(
          fmt::format("{}: the rigid link of node {} of body {} lies in several of its {} frames; expected "
                      "fewer frames, which do not cut it",
                      frames_of(body), whole.mesh.node_labels[independent_node], body.name, body.frames));
    if (of_nodes[independent_node].empty()) of_nodes[independent_node] = {pieces->front()};
  }
  std::vector<int> all;
  for (const mesh::DependentNode& link : whole.links) {
    all.push_back(shared.at(link.independent_node)->front());
    if (of_nodes[link.node].empty()) of_nodes[link.node] = {all.back()};
  }
  return all;
}

void refuse_unconnected(const Body& body, int pieces, const std::vector<CutMesh::Cut>& cuts) {
  math::DisjointSets<int> sets(static_cast<std::size_t>(pieces));
  for (const CutMesh::Cut& cut : cuts) sets.join(cut.first, cut.second);
  for (int piece = 0; piece < pieces; ++piece)
    if (sets.root(piece) != 0)
      throw InputError(
          fmt::format("{}: the mesh of body {} has unconnected parts; expected one connected mesh (join "
                      "them by common nodes)",
                      body.mesh.where.text(), body.name));
}

std::vector<PetscInt> nodes_of(const Body& body, const RawMesh& mesh, const Place& place) {
  if (place.point || place.name == "middle") {
    const Vector3d x = vector(place.point ? *place.point : place_point(body.mesh, place));
    const auto nearest = std::min_element(
        mesh.positions.begin(), mesh.positions.end(),
        [&](const Vector3d& a, const Vector3d& b) { return (a - x).squaredNorm() < (b - x).squaredNorm(); });
    return {static_cast<PetscInt>(nearest - mesh.positions.begin())};  // how near is checked on the piece
  }
  const auto found = std::find(mesh.places.begin(), mesh.places.end(), place.name);
  if (found != mesh.places.end()) return mesh.place_nodes[found - mesh.places.begin()];
  const std::string near = math::nearest(place.name, mesh.places);
  throw InputError(fmt::format("{}: {} has no place \"{}\"; expected {}coordinates{}", place.where.text(), body.name,
                               place.name,
                               mesh.places.empty() ? "" : fmt::format("one of {} or ", fmt::join(mesh.places, ", ")),
                               near.empty() ? "" : "; did you mean \"" + near + "\"?"));
}

}  // namespace

std::vector<int> CutMesh::pieces_of(const Body& body, const Place& place) const {
  std::vector<int> shared(pieces.size());
  std::iota(shared.begin(), shared.end(), 0);
  for (PetscInt node : nodes_of(body, whole.mesh, place)) shared = common(shared, of_nodes[node]);
  return shared;
}

std::vector<int> CutMesh::pieces_with_shells(const std::string& part) const {
  std::vector<int> found;
  const std::vector<int>& of_elements = *pieces.front()->of_elements;
  for (std::size_t c = 0; c < of_elements.size(); ++c) {
    const Cell& cell = whole.mesh.cells[c];
    if (mesh::is_shell(cell.kind) && (part.empty() || whole.mesh.parts[cell.part] == part))
      found.push_back(of_elements[c]);
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

namespace {

/// The piece of an element without extent: a point mass, of links' independent nodes too, or a spring.
int piece_of(const Body& body, const CutMesh& cut, const Cell& cell) {
  if (cell.kind != mesh::CellKind::spring) return cut.of_nodes[cell.nodes[0]].front();
  const std::vector<int> both = common(cut.of_nodes[cell.nodes[0]], cut.of_nodes[cell.nodes[1]]);
  const std::vector<long long>& labels = cut.whole.mesh.node_labels;
  if (both.empty())
    throw InputError(
        fmt::format("{}: the spring between nodes {} and {} of body {} joins two of its {} frames; "
                    "expected fewer frames, of which one has both nodes",
                    frames_of(body), labels[cell.nodes[0]], labels[cell.nodes[1]], body.name, body.frames));
  return both.front();
}

}  // namespace

CutMesh cut_mesh(const Body& body, MPI_Comm comm) {
  CutMesh found{whole_mesh(body, comm), {}, {}, {}};
  const RawMesh& mesh = found.whole.mesh;
  std::vector<int> of_elements = pieces_of_elements(body, found.whole);
  const int count = 1 + *std::max_element(of_elements.begin(), of_elements.end());
  found.of_nodes = pieces_of_nodes(mesh, of_elements);
  const std::vector<std::vector<int>> by_elements = found.of_nodes;
  add_nodes_of_springs(mesh, found.of_nodes);
  const std::vector<int> of_links = pieces_of_links(body, found.whole, found.of_nodes);
  for (std::size_t c = 0; c < of_elements.size(); ++c)
    if (of_elements[c] < 0) of_elements[c] = piece_of(body, found, mesh.cells[c]);
  std::vector<MeshPiece> pieces(static_cast<std::size_t>(count));
  for (std::size_t node = 0; node < by_elements.size(); ++node)
    for (std::size_t i = 1; i < by_elements[node].size(); ++i) {
      const int p = by_elements[node][i - 1], q = by_elements[node][i];
      const std::string name = fmt::format("cut {}-{}", p + 1, q + 1);
      if (pieces[p].cuts[name].empty()) found.cuts.push_back({p, q, name});
      for (int piece : {p, q}) pieces[piece].cuts[name].push_back(static_cast<long long>(node));
    }
  std::sort(found.cuts.begin(), found.cuts.end(),
            [](const auto& a, const auto& b) { return std::pair(a.first, a.second) < std::pair(b.first, b.second); });
  refuse_unconnected(body, count, found.cuts);
  for (std::size_t l = 0; l < of_links.size(); ++l) pieces[of_links[l]].links.push_back(static_cast<int>(l));
  const auto shared = std::make_shared<const std::vector<int>>(std::move(of_elements));
  for (int p = 0; p < count; ++p) {
    pieces[p].number = p, pieces[p].of_elements = shared;
    found.pieces.push_back(std::make_shared<const MeshPiece>(std::move(pieces[p])));
  }
  return found;
}

}  // namespace floe::plan
