#include "floe/mesh/links.h"

#include <fmt/format.h>

#include <algorithm>

#include "all_ranks.h"
#include "floe/error.h"

namespace floe::mesh {
namespace {

/// Labels of nodes, in their order. Collective; `nodes` the same on all ranks.
std::vector<long long> labels_of(const RawMesh& mesh, const std::vector<PetscInt>& nodes) {
  const std::vector<PetscInt> starts = starts_of(mesh.comm, static_cast<PetscInt>(mesh.positions.size()));
  return ask<long long>(
      mesh.comm, nodes, [&](PetscInt node) { return owner_of(starts, node); },
      [&](PetscInt node) { return mesh.node_labels[node - mesh.first_node]; });
}

bool before(const DependentNode& a, PetscInt node) { return a.node < node; }

/// A node whose independent node depends on another one moves with that one: rigid links compose.
/// @return  nodes that lead back to themselves
std::vector<PetscInt> follow_chains(std::vector<DependentNode>& all) {
  const std::vector<DependentNode> given = all;
  std::vector<PetscInt> round;
  for (DependentNode& link : all) {
    for (std::size_t steps = 0; steps <= given.size(); ++steps) {
      const PetscInt next = independent_node_of(given, link.independent_node);
      if (next == link.independent_node) break;
      link.independent_node = next;
      if (next != link.node) continue;
      round.push_back(link.node);
      break;
    }
  }
  return round;
}

}  // namespace

PetscInt independent_node_of(const std::vector<DependentNode>& dependent_nodes, PetscInt node) {
  const auto found = std::lower_bound(dependent_nodes.begin(), dependent_nodes.end(), node, before);
  return found != dependent_nodes.end() && found->node == node ? found->independent_node : node;
}

std::vector<DependentNode> dependent_nodes(const RawMesh& mesh, const std::vector<RigidLink>& links) {
  std::vector<DependentNode> mine;
  for (const RigidLink& link : links)
    for (PetscInt node : link.nodes)
      if (node != link.reference) mine.push_back({node, link.reference});
  std::vector<DependentNode> all = of_all_ranks(mesh.comm, mine);
  const auto order = [](const DependentNode& a) { return std::pair(a.node, a.independent_node); };
  std::sort(all.begin(), all.end(),
            [&](const DependentNode& a, const DependentNode& b) { return order(a) < order(b); });
  all.erase(std::unique(all.begin(), all.end(),
                        [&](const DependentNode& a, const DependentNode& b) { return order(a) == order(b); }),
            all.end());
  std::vector<PetscInt> twice;
  for (std::size_t i = 1; i < all.size(); ++i)
    if (all[i].node == all[i - 1].node) twice.push_back(all[i].node);
  const std::vector<PetscInt> round = follow_chains(all);
  std::vector<std::string> faults;
  for (long long label : labels_of(mesh, twice))
    faults.push_back(fmt::format("{}: node {} is in rigid links to two nodes; expected one", mesh.source, label));
  for (long long label : labels_of(mesh, round))
    faults.push_back(fmt::format("{}: rigid links lead from node {} back to it; expected one that depends on no other",
                                 mesh.source, label));
  if (!faults.empty()) throw InputError(faults);
  return all;
}

}  // namespace floe::mesh
