#include "components.h"

#include <algorithm>

#include "floe/math/disjoint_sets.h"
#include "floe/mesh/exchange.h"
#include "floe/mesh/labels.h"

namespace floe::mesh {
namespace {

struct Proposal {
  PetscInt node, least;
};

Translation nodes_here(const RawMesh& mesh, const std::vector<std::array<PetscInt, 2>>& connections) {
  std::vector<long long> nodes;
  for (const auto& cell : mesh.cells)
    nodes.insert(nodes.end(), cell.nodes.begin(), cell.nodes.begin() + node_count(cell.kind));
  for (const auto& pair : connections) nodes.insert(nodes.end(), pair.begin(), pair.end());
  return Translation(std::move(nodes));
}

// Of each node of the share the least node of its component.
std::vector<PetscInt> least_nodes(const RawMesh& mesh, const std::vector<std::array<PetscInt, 2>>& connections,
                                  const std::vector<PetscInt>& starts) {
  const Translation here = nodes_here(mesh, connections);
  const std::size_t count = here.keys().size();
  math::DisjointSets<PetscInt> forest(count);
  for (const auto& cell : mesh.cells)
    for (int i = 1; i < node_count(cell.kind); ++i)
      forest.join(here.position(cell.nodes[0]), here.position(cell.nodes[i]));
  for (const auto& pair : connections) forest.join(here.position(pair[0]), here.position(pair[1]));
  std::vector<PetscInt> of_root(count), least(mesh.positions.size());
  for (std::size_t i = 0; i < count; ++i) of_root[i] = static_cast<PetscInt>(here.keys()[i]);
  std::iota(least.begin(), least.end(), mesh.first_node);
  const auto owner = [&](const Proposal& proposal) { return owner_of(starts, proposal.node); };
  for (bool changed = true; changed;) {
    std::vector<Proposal> proposals(count);
    for (std::size_t i = 0; i < count; ++i)
      proposals[i] = {static_cast<PetscInt>(here.keys()[i]), of_root[forest.root(static_cast<PetscInt>(i))]};
    for (const auto& [node, value] : scatter(mesh.comm, proposals, owner).values)
      least[node - mesh.first_node] = std::min(least[node - mesh.first_node], value);
    const auto answers =
        ask<PetscInt>(mesh.comm, proposals, owner, [&](const Proposal& p) { return least[p.node - mesh.first_node]; });
    bool mine = false;
    for (std::size_t i = 0; i < count; ++i) {
      auto& value = of_root[forest.root(static_cast<PetscInt>(i))];
      mine = mine || answers[i] < value;
      value = std::min(value, answers[i]);
    }
    MPI_Allreduce(&mine, &changed, 1, MPI_C_BOOL, MPI_LOR, mesh.comm);
  }
  return least;
}

struct Sized {
  PetscInt root, nodes;
  long long label;
};

bool before(const Sized& a, const Sized& b) { return a.nodes != b.nodes ? a.nodes > b.nodes : a.root < b.root; }

}  // namespace

void find_components(const RawMesh& mesh, const std::vector<std::array<PetscInt, 2>>& connections, Inspection& result) {
  constexpr std::size_t most = 10;
  int ranks = 1;
  MPI_Comm_size(mesh.comm, &ranks);
  const auto starts = starts_of(mesh.comm, static_cast<PetscInt>(mesh.positions.size()));
  const auto roots = least_nodes(mesh, connections, starts);
  std::vector<PetscInt> sizes(mesh.positions.size(), 0);
  const auto told = scatter(mesh.comm, roots, [&](PetscInt root) { return owner_of(starts, root); });
  for (const PetscInt root : told.values) ++sizes[root - mesh.first_node];
  std::vector<Sized> mine;
  for (std::size_t i = 0; i < sizes.size(); ++i)
    if (sizes[i] > 0) mine.push_back({mesh.first_node + static_cast<PetscInt>(i), sizes[i], mesh.node_labels[i]});
  const auto count = static_cast<PetscInt>(mine.size());
  MPI_Allreduce(&count, &result.component_count, 1, MPIU_INT, MPI_SUM, mesh.comm);
  std::sort(mine.begin(), mine.end(), before);
  mine.resize(std::min(mine.size(), most));
  std::vector<Sized> to_all;
  for (int r = 0; r < ranks; ++r) to_all.insert(to_all.end(), mine.begin(), mine.end());
  auto all = exchange(mesh.comm, to_all, std::vector<int>(ranks, static_cast<int>(mine.size()))).values;
  std::sort(all.begin(), all.end(), before);
  all.resize(std::min(all.size(), most));
  for (const auto& [root, nodes, label] : all) result.components.push_back({nodes, label});
}

}  // namespace floe::mesh
