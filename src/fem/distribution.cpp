#include <algorithm>

#include "floe/fem/mesh.h"
#include "floe/mesh/exchange.h"

namespace floe::fem {
namespace {

struct Node {
  PetscInt original;
  double x[3];
};

struct NewCell {
  CellKind kind;
  int part;
  std::array<PetscInt, 4> nodes;  // new global numbers, -1 where unused
};

int rank_of(MPI_Comm comm) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  return rank;
}

/// Moves the nodes; numbers them on their new ranks in the order of their original numbers. Collective.
void move_nodes(const mesh::RawMesh& raw, const std::vector<int>& ranks, Mesh& mesh) {
  std::vector<Node> nodes(raw.positions.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const Eigen::Vector3d& x = raw.positions[i];
    nodes[i] = {raw.first_node + static_cast<PetscInt>(i), {x.x(), x.y(), x.z()}};
  }
  const auto rank_of_node = [&](const Node& node) { return ranks[node.original - raw.first_node]; };
  const auto arrived = mesh::scatter(mesh.comm, nodes, rank_of_node);  // shares ascend with ranks: in order
  mesh.owned_nodes = static_cast<PetscInt>(arrived.values.size());
  const std::vector<PetscInt> starts = mesh::starts_of(mesh.comm, mesh.owned_nodes);
  mesh.first_node = starts[rank_of(mesh.comm)];
  for (const Node& node : arrived.values) {
    mesh.original.push_back(node.original);
    mesh.positions.emplace_back(node.x[0], node.x[1], node.x[2]);
  }
  // Where each rank's batch begins on the rank that it went to.
  const int size = static_cast<int>(arrived.counts.size());
  std::vector<PetscInt> begins(size), next(size);
  for (int r = 0; r < size; ++r) begins[r] = mesh.first_node + arrived.starts[r];
  MPI_Alltoall(begins.data(), 1, MPIU_INT, next.data(), 1, MPIU_INT, mesh.comm);
  auto renumbering = std::make_shared<Mesh::Renumbering>();
  renumbering->starts = mesh::starts_of(mesh.comm, static_cast<PetscInt>(raw.positions.size()));
  for (int rank : ranks) renumbering->global.push_back(next[rank]++);
  mesh.renumbering = std::move(renumbering);
}

/// Cells to the ranks of their first nodes. Collective.
std::vector<NewCell> move_cells(const mesh::RawMesh& raw, const Mesh& mesh) {
  std::vector<PetscInt> originals;
  for (const mesh::Cell& cell : raw.cells)
    originals.insert(originals.end(), cell.nodes.begin(), cell.nodes.begin() + mesh::node_count(cell.kind));
  std::vector<PetscInt> needed = originals;
  std::sort(needed.begin(), needed.end());
  needed.erase(std::unique(needed.begin(), needed.end()), needed.end());
  const std::vector<PetscInt> found = global_nodes(mesh, needed);
  std::vector<NewCell> cells;
  std::size_t at = 0;
  for (const mesh::Cell& cell : raw.cells) {
    NewCell moved{cell.kind, cell.part, {-1, -1, -1, -1}};
    for (int i = 0; i < mesh::node_count(cell.kind); ++i)
      moved.nodes[i] = found[std::lower_bound(needed.begin(), needed.end(), originals[at++]) - needed.begin()];
    cells.push_back(moved);
  }
  const std::vector<PetscInt> starts = mesh::starts_of(mesh.comm, mesh.owned_nodes);
  return mesh::scatter(mesh.comm, cells, [&](const NewCell& cell) { return mesh::owner_of(starts, cell.nodes[0]); })
      .values;
}

/// Copies of the foreign nodes that this rank's cells touch. Collective.
void fetch_foreign(const std::vector<NewCell>& cells, Mesh& mesh) {
  const PetscInt begin = mesh.first_node, end = begin + mesh.owned_nodes;
  for (const NewCell& cell : cells)
    for (int i = 0; i < mesh::node_count(cell.kind); ++i)
      if (cell.nodes[i] < begin || cell.nodes[i] >= end) mesh.foreign.push_back(cell.nodes[i]);
  std::sort(mesh.foreign.begin(), mesh.foreign.end());
  mesh.foreign.erase(std::unique(mesh.foreign.begin(), mesh.foreign.end()), mesh.foreign.end());
  const std::vector<PetscInt> starts = mesh::starts_of(mesh.comm, mesh.owned_nodes);
  const auto nodes = mesh::ask<Node>(
      mesh.comm, mesh.foreign, [&](PetscInt node) { return mesh::owner_of(starts, node); },
      [&](PetscInt node) {
        const Eigen::Vector3d& x = mesh.positions[node - begin];
        return Node{mesh.original[node - begin], {x.x(), x.y(), x.z()}};
      });
  for (const Node& node : nodes) {
    mesh.original.push_back(node.original);
    mesh.positions.emplace_back(node.x[0], node.x[1], node.x[2]);
  }
}

}  // namespace

Mesh mesh_of(const mesh::RawMesh& raw, const std::vector<int>& ranks) {
  Mesh mesh;
  mesh.comm = raw.comm;
  mesh.dimension = 3;
  mesh.node_count = raw.node_count, mesh.cell_count = raw.cell_count;
  move_nodes(raw, ranks, mesh);
  const std::vector<NewCell> cells = move_cells(raw, mesh);
  fetch_foreign(cells, mesh);
  const PetscInt begin = mesh.first_node, end = begin + mesh.owned_nodes;
  for (const NewCell& cell : cells) {
    Mesh::Cell local{cell.kind, cell.part, {}};
    for (int i = 0; i < mesh::node_count(cell.kind); ++i) {
      const PetscInt node = cell.nodes[i];
      const auto foreign = std::lower_bound(mesh.foreign.begin(), mesh.foreign.end(), node) - mesh.foreign.begin();
      local.corner[i] = static_cast<int>(node >= begin && node < end ? node - begin : mesh.owned_nodes + foreign);
    }
    mesh.cells.push_back(local);
  }
  return mesh;
}

std::vector<PetscInt> global_nodes(const Mesh& mesh, const std::vector<PetscInt>& originals) {
  if (!mesh.renumbering) return originals;
  const Mesh::Renumbering& table = *mesh.renumbering;
  const PetscInt first = table.starts[rank_of(mesh.comm)];
  return mesh::ask<PetscInt>(
      mesh.comm, originals, [&](PetscInt node) { return mesh::owner_of(table.starts, node); },
      [&](PetscInt node) { return table.global[node - first]; });
}

}  // namespace floe::fem
