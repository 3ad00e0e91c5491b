#include "node_graph.h"

#include <algorithm>

#include "floe/mesh/exchange.h"

namespace floe::mesh {
namespace {

struct Edge {
  PetscInt from, to;
  auto operator<=>(const Edge&) const = default;
};

void sort_unique(std::vector<Edge>& edges) {
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
}

}  // namespace

NodeGraph node_graph(const RawMesh& mesh) {
  const auto starts = starts_of(mesh.comm, static_cast<PetscInt>(mesh.positions.size()));
  std::vector<Edge> edges;
  for (const auto& cell : mesh.cells)
    for (int i = 0; i < node_count(cell.kind); ++i)
      for (int j = 0; j < node_count(cell.kind); ++j)
        if (cell.nodes[i] != cell.nodes[j]) edges.push_back({cell.nodes[i], cell.nodes[j]});
  sort_unique(edges);
  edges = scatter(mesh.comm, edges, [&](const Edge& edge) { return owner_of(starts, edge.from); }).values;
  sort_unique(edges);
  NodeGraph graph;
  graph.rows.assign(mesh.positions.size() + 1, 0);
  for (const auto& edge : edges) {
    ++graph.rows[edge.from - mesh.first_node + 1];
    graph.columns.push_back(edge.to);
  }
  std::partial_sum(graph.rows.begin(), graph.rows.end(), graph.rows.begin());
  return graph;
}

}  // namespace floe::mesh
