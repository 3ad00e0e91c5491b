#include "floe/mesh/pieces.h"

#include <map>

namespace floe::mesh {
namespace {

/// Nodes that are joined, directly or through others: each set by one of its nodes.
class Joined {
 public:
  PetscInt root(PetscInt node) {
    for (next_.emplace(node, node); next_[node] != node;) node = next_[node] = next_[next_[node]];
    return node;
  }
  void join(PetscInt one, PetscInt other) { next_[root(one)] = root(other); }
  /// Ascending nodes of each set.
  std::map<PetscInt, std::vector<PetscInt>> sets() {
    std::map<PetscInt, std::vector<PetscInt>> all;
    for (const auto& entry : next_) all[root(entry.first)].push_back(entry.first);
    return all;
  }

 private:
  std::map<PetscInt, PetscInt> next_;  // towards the root
};

}  // namespace

std::vector<Follower> with_pieces(const std::vector<Follower>& links,
                                  const std::vector<std::vector<PetscInt>>& pieces) {
  if (pieces.empty()) return links;
  Joined joined;
  for (const Follower& link : links) joined.join(link.node, link.leader);
  for (const std::vector<PetscInt>& piece : pieces)
    for (PetscInt node : piece) joined.join(node, piece.front());
  std::map<PetscInt, PetscInt> leader;  // of each root: of several references the least
  for (const Follower& link : links) {
    const auto [at, fresh] = leader.emplace(joined.root(link.leader), link.leader);
    if (!fresh) at->second = std::min(at->second, link.leader);
  }
  std::map<PetscInt, PetscInt> all;
  for (const auto& [root, nodes] : joined.sets()) {
    const auto given = leader.find(root);
    const PetscInt first = given == leader.end() ? nodes[nodes.size() / 2] : given->second;
    for (PetscInt node : nodes)
      if (node != first) all.emplace(node, first);
  }
  std::vector<Follower> followers;
  for (const auto& [node, first] : all) followers.push_back({node, first});
  return followers;
}

}  // namespace floe::mesh
