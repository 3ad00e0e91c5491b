#include <algorithm>

#include "floe/fem/mesh.h"
#include "floe/mesh/exchange.h"
#include "floe/petsc/rank.h"
#include "surface_rise.h"

namespace floe::fem {
namespace {

struct Node {
  PetscInt original;
  double x[3];
};

struct NewCell {
  CellKind kind;
  int part;
  std::array<PetscInt, mesh::most_nodes> nodes;  // new global numbers, of the kind's number
};

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
  mesh.first_node = starts[petsc::rank_of(mesh.comm)];
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

/// The ranks of dependent nodes: those of their independent nodes. Collective.
void follow(const mesh::RawMesh& raw, const std::vector<mesh::DependentNode>& dependent_nodes,
            std::vector<int>& ranks) {
  const auto mine = [&](PetscInt node) {
    return node >= raw.first_node && node < raw.first_node + static_cast<PetscInt>(ranks.size());
  };
  std::vector<int> rank(dependent_nodes.size(), -1);
  for (std::size_t i = 0; i < dependent_nodes.size(); ++i)
    if (mine(dependent_nodes[i].independent_node))
      rank[i] = ranks[dependent_nodes[i].independent_node - raw.first_node];
  MPI_Allreduce(MPI_IN_PLACE, rank.data(), static_cast<int>(rank.size()), MPI_INT, MPI_MAX, raw.comm);
  for (std::size_t i = 0; i < dependent_nodes.size(); ++i)
    if (mine(dependent_nodes[i].node)) ranks[dependent_nodes[i].node - raw.first_node] = rank[i];
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
    NewCell moved{cell.kind, cell.part, mesh::no_nodes<PetscInt>()};
    for (int i = 0; i < mesh::node_count(cell.kind); ++i)
      moved.nodes[i] = found[std::lower_bound(needed.begin(), needed.end(), originals[at++]) - needed.begin()];
    cells.push_back(moved);
  }
  const std::vector<PetscInt> starts = mesh::starts_of(mesh.comm, mesh.owned_nodes);
  return mesh::scatter(mesh.comm, cells, [&](const NewCell& cell) { return mesh::owner_of(starts, cell.nodes[0]); })
      .values;
}

/// Copies of the foreign nodes that this rank's cells touch, and of those that these follow. Collective.
/// @param dependent_nodes  by new global numbers
void fetch_foreign(const std::vector<NewCell>& cells, const std::vector<mesh::DependentNode>& dependent_nodes,
                   Mesh& mesh) {
  const PetscInt begin = mesh.first_node, end = begin + mesh.owned_nodes;
  for (const NewCell& cell : cells)
    for (int i = 0; i < mesh::node_count(cell.kind); ++i)
      for (const PetscInt node : {cell.nodes[i], mesh::independent_node_of(dependent_nodes, cell.nodes[i])})
        if (node < begin || node >= end) mesh.foreign.push_back(node);
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

/// Dependent nodes by new global numbers, ascending. Collective.
std::vector<mesh::DependentNode> renumbered(const Mesh& mesh, const std::vector<mesh::DependentNode>& dependent_nodes) {
  std::vector<PetscInt> originals;
  for (const mesh::DependentNode& f : dependent_nodes)
    originals.push_back(f.node), originals.push_back(f.independent_node);
  const std::vector<PetscInt> found = global_nodes(mesh, originals);
  std::vector<mesh::DependentNode> all;
  for (std::size_t i = 0; i < found.size(); i += 2)
    all.push_back({found[i], found[i + 1], dependent_nodes[i / 2].axis, dependent_nodes[i / 2].others});
  std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.node < b.node; });
  return all;
}

bool spins(const std::vector<mesh::DependentNode>& links, PetscInt node) {
  const auto found = std::lower_bound(links.begin(), links.end(), node,
                                      [](const mesh::DependentNode& f, PetscInt wanted) { return f.node < wanted; });
  return found != links.end() && found->node == node && found->spins();
}

/// The independent node of a corner with rotations of its own among the nodes that the cell acts on.
void lead(Mesh::Cell& cell, int corner, int independent_node) {
  const auto end = cell.moved.begin() + cell.moving;
  const auto found = std::find(cell.moved.begin(), end, independent_node);
  cell.line[corner] = static_cast<int>(found - cell.moved.begin());
  if (found == end) cell.moved[cell.moving++] = independent_node;
}

}  // namespace

Mesh mesh_of(const mesh::RawMesh& raw, std::vector<int> ranks,
             const std::vector<mesh::DependentNode>& dependent_nodes) {
  Mesh mesh;
  mesh.comm = raw.comm;
  mesh.dimension = 3;
  mesh.node_count = raw.node_count, mesh.cell_count = raw.cell_count;
  follow(raw, dependent_nodes, ranks);
  move_nodes(raw, ranks, mesh);
  const std::vector<NewCell> cells = move_cells(raw, mesh);
  const std::vector<mesh::DependentNode> links = renumbered(mesh, dependent_nodes);
  fetch_foreign(cells, links, mesh);
  const PetscInt begin = mesh.first_node, end = begin + mesh.owned_nodes;
  const auto local = [&](PetscInt node) {
    const auto foreign = std::lower_bound(mesh.foreign.begin(), mesh.foreign.end(), node) - mesh.foreign.begin();
    return static_cast<int>(node >= begin && node < end ? node - begin : mesh.owned_nodes + foreign);
  };
  for (const NewCell& cell : cells) {
    Mesh::Cell own(cell.kind, cell.part, {});
    for (int i = 0; i < mesh::node_count(cell.kind); ++i) {
      own.place[i] = local(cell.nodes[i]);
      own.moved[i] =
          local(spins(links, cell.nodes[i]) ? cell.nodes[i] : mesh::independent_node_of(links, cell.nodes[i]));
    }
    for (int i = 0; i < mesh::node_count(cell.kind); ++i)
      if (spins(links, cell.nodes[i])) lead(own, i, local(mesh::independent_node_of(links, cell.nodes[i])));
    mesh.cells.push_back(own);
  }
  const auto is_local = [&](PetscInt node) {
    return (node >= begin && node < end) || std::binary_search(mesh.foreign.begin(), mesh.foreign.end(), node);
  };
  for (const mesh::DependentNode& f : links) {
    if (f.node >= begin && f.node < end) mesh.dependent_nodes.push_back({local(f.node), local(f.independent_node)});
    if (f.spins() && is_local(f.node))
      mesh.spins.push_back({local(f.node), Eigen::Vector3d(f.axis[0], f.axis[1], f.axis[2]), f.others});
  }
  std::sort(mesh.spins.begin(), mesh.spins.end(), [](const auto& a, const auto& b) { return a.node < b.node; });
  set_rises(mesh);
  return mesh;
}

std::vector<PetscInt> global_nodes(const Mesh& mesh, const std::vector<PetscInt>& originals) {
  if (!mesh.renumbering) return originals;
  const Mesh::Renumbering& table = *mesh.renumbering;
  const PetscInt first = table.starts[petsc::rank_of(mesh.comm)];
  return mesh::ask<PetscInt>(
      mesh.comm, originals, [&](PetscInt node) { return mesh::owner_of(table.starts, node); },
      [&](PetscInt node) { return table.global[node - first]; });
}

std::vector<PetscInt> dependent_dofs(const Mesh& mesh, int dofs_per_node) {
  std::vector<PetscInt> mine;
  for (const Mesh::DependentNode& f : mesh.dependent_nodes) {
    const Mesh::Spin* spin = spin_of(mesh, f.node);
    const Eigen::Matrix3d own = spin ? spin->own() : Eigen::Matrix3d::Zero().eval();
    for (int d = 0; d < dofs_per_node; ++d)
      if (d < 3 || dofs_per_node == 3 || own.col(d - 3).isZero(0))
        mine.push_back(dofs_per_node * mesh.global_node(f.node) + d);
  }
  int ranks = 1;
  MPI_Comm_size(mesh.comm, &ranks);
  std::vector<PetscInt> copies;
  for (int r = 0; r < ranks; ++r) copies.insert(copies.end(), mine.begin(), mine.end());
  return mesh::exchange(mesh.comm, copies, std::vector<int>(ranks, static_cast<int>(mine.size()))).values;
}

}  // namespace floe::fem
