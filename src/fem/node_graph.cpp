#include "node_graph.h"

#include <algorithm>
#include <array>

namespace floe::fem {
namespace {

using Edge = std::array<PetscInt, 2>;  // row <= column, global

/// Rank that owns a node, from the first node of each rank.
int owner_of(const std::vector<PetscInt>& first, PetscInt node) {
  return static_cast<int>(std::upper_bound(first.begin(), first.end(), node) - first.begin()) - 1;
}

/// Edges whose row is another rank's, to that rank. Collective.
std::vector<Edge> deliver(const Mesh& mesh, std::vector<Edge> foreign) {
  int size = 1;
  MPI_Comm_size(mesh.comm, &size);
  std::vector<PetscInt> first(size);
  MPI_Allgather(&mesh.first_node, 1, MPIU_INT, first.data(), 1, MPIU_INT, mesh.comm);
  std::sort(foreign.begin(), foreign.end());
  foreign.erase(std::unique(foreign.begin(), foreign.end()), foreign.end());
  std::vector<int> send(size, 0), receive(size), send_at(size, 0), receive_at(size, 0);
  for (const Edge& edge : foreign) send[owner_of(first, edge[0])] += 2;  // rows ascend, so do owners
  MPI_Alltoall(send.data(), 1, MPI_INT, receive.data(), 1, MPI_INT, mesh.comm);
  for (int r = 1; r < size; ++r) {
    send_at[r] = send_at[r - 1] + send[r - 1];
    receive_at[r] = receive_at[r - 1] + receive[r - 1];
  }
  std::vector<Edge> mine((receive_at[size - 1] + receive[size - 1]) / 2);
  MPI_Alltoallv(foreign.data(), send.data(), send_at.data(), MPIU_INT, mine.data(), receive.data(), receive_at.data(),
                MPIU_INT, mesh.comm);
  return mine;
}

}  // namespace

NodeGraph node_graph(const Mesh& mesh) {
  const PetscInt begin = mesh.first_node, end = begin + mesh.owned_nodes;
  std::vector<std::vector<PetscInt>> columns(mesh.owned_nodes);
  std::vector<Edge> foreign;
  const auto add = [&](PetscInt row, PetscInt column) { columns[row - begin].push_back(column); };
  for (const Mesh::Cell& cell : mesh.cells) {
    for (int a : cell.nodes()) {
      for (int b : cell.nodes()) {
        const PetscInt row = mesh.global_node(a), column = mesh.global_node(b);
        if (row > column) continue;
        if (row >= begin && row < end)
          add(row, column);
        else
          foreign.push_back({row, column});
      }
    }
  }
  for (const Edge& edge : deliver(mesh, std::move(foreign))) add(edge[0], edge[1]);
  NodeGraph graph{std::vector<PetscInt>(mesh.owned_nodes, 0), std::vector<PetscInt>(mesh.owned_nodes, 0)};
  for (PetscInt row = 0; row < mesh.owned_nodes; ++row) {
    auto& all = columns[row];
    all.push_back(begin + row);  // the diagonal stands even at a node without cells
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    for (PetscInt column : all) ++(column < end ? graph.own : graph.other)[row];
  }
  return graph;
}

}  // namespace floe::fem
