#include "floe/mesh/raw_mesh.h"

#include <algorithm>
#include <iterator>

namespace floe::mesh {

Share share_of(PetscInt count, int rank, int ranks) {
  const auto start = [&](long long r) { return static_cast<PetscInt>(r * count / ranks); };
  return {start(rank), start(rank + 1) - start(rank)};
}

RawMesh share_of_whole(const RawMesh& whole) {
  int rank = 0, ranks = 1;
  MPI_Comm_rank(whole.comm, &rank);
  MPI_Comm_size(whole.comm, &ranks);
  RawMesh mesh;
  mesh.comm = whole.comm, mesh.source = whole.source;
  mesh.parts = whole.parts, mesh.places = whole.places;
  mesh.node_count = whole.node_count, mesh.cell_count = whole.cell_count;
  const Share nodes = share_of(mesh.node_count, rank, ranks), cells = share_of(mesh.cell_count, rank, ranks);
  mesh.first_node = nodes.first, mesh.first_cell = cells.first;
  const auto copy = [](const auto& from, Share share, auto& into) {
    into.assign(from.begin() + share.first, from.begin() + share.first + share.count);
  };
  copy(whole.positions, nodes, mesh.positions), copy(whole.node_labels, nodes, mesh.node_labels);
  copy(whole.cells, cells, mesh.cells), copy(whole.cell_labels, cells, mesh.cell_labels);
  const auto own = [&](PetscInt node) { return node >= nodes.first && node < nodes.first + nodes.count; };
  for (const std::vector<PetscInt>& all : whole.place_nodes)
    std::copy_if(all.begin(), all.end(), std::back_inserter(mesh.place_nodes.emplace_back()), own);
  for (const auto& [name, all] : whole.place_weights)
    std::copy_if(all.begin(), all.end(), std::back_inserter(mesh.place_weights[name]),
                 [&](const NodeWeight& at) { return own(at.node); });
  return mesh;
}

std::vector<PetscInt> starts_of(MPI_Comm comm, PetscInt count) {
  int ranks = 1;
  MPI_Comm_size(comm, &ranks);
  std::vector<PetscInt> starts(ranks + 1, 0);
  MPI_Allgather(&count, 1, MPIU_INT, starts.data() + 1, 1, MPIU_INT, comm);
  for (int r = 0; r < ranks; ++r) starts[r + 1] += starts[r];
  return starts;
}

int owner_of(const std::vector<PetscInt>& starts, PetscInt i) {
  return static_cast<int>(std::upper_bound(starts.begin(), starts.end(), i) - starts.begin()) - 1;
}

}  // namespace floe::mesh
