#include "floe/mesh/pieces.h"

#include <Eigen/Dense>
#include <algorithm>
#include <map>
#include <set>

#include "floe/error.h"

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

std::vector<DependentNode> with_pieces(const std::vector<DependentNode>& links,
                                       const std::vector<std::vector<PetscInt>>& pieces) {
  if (pieces.empty()) return links;
  Joined joined;
  for (const DependentNode& link : links)
    if (!link.spins()) joined.join(link.node, link.independent_node);
  for (const std::vector<PetscInt>& piece : pieces)
    for (PetscInt node : piece) joined.join(node, piece.front());
  std::map<PetscInt, PetscInt> independent_node;  // of each root: of several references the least
  for (const DependentNode& link : links) {
    if (link.spins()) continue;
    const auto [at, fresh] = independent_node.emplace(joined.root(link.independent_node), link.independent_node);
    if (!fresh) at->second = std::min(at->second, link.independent_node);
  }
  std::map<PetscInt, PetscInt> all;
  for (const auto& [root, nodes] : joined.sets()) {
    const auto given = independent_node.find(root);
    const PetscInt first = given == independent_node.end() ? nodes[nodes.size() / 2] : given->second;
    for (PetscInt node : nodes)
      if (node != first) all.emplace(node, first);
  }
  std::map<PetscInt, DependentNode> dependent_nodes;
  for (const auto& [node, first] : all) dependent_nodes.emplace(node, DependentNode{node, first});
  for (DependentNode link : links) {
    if (!link.spins()) continue;
    const auto rigid = all.find(link.independent_node);
    if (rigid != all.end()) link.independent_node = rigid->second;
    dependent_nodes.emplace(link.node, link);
  }
  std::vector<DependentNode> ascending;
  for (const auto& [node, link] : dependent_nodes) ascending.push_back(link);
  return ascending;
}

namespace {

std::vector<PetscInt> in_common(const HingeLine& one, const HingeLine& other) {
  std::vector<PetscInt> both;
  std::set_intersection(one.nodes.begin(), one.nodes.end(), other.nodes.begin(), other.nodes.end(),
                        std::back_inserter(both));
  return both;
}

double angle(const HingeLine& one, const HingeLine& other) {
  const Eigen::Map<const Eigen::Vector3d> a(one.axis.data()), b(other.axis.data());
  return a.cross(b).norm();
}

bool parallel(const HingeLine& one, const HingeLine& other) { return angle(one, other) < 1e-6; }

bool one_line(const HingeLine& one, const HingeLine& other) {
  const std::size_t common = in_common(one, other).size();
  return common > 1 || (common == 1 && !one.holder.empty() && one.holder == other.holder && parallel(one, other));
}

/// Lines that are parts of one line made one; nodes ascend.
std::vector<HingeLine> joined(std::vector<HingeLine> lines) {
  std::vector<HingeLine> all;
  for (HingeLine& line : lines) {
    std::sort(line.nodes.begin(), line.nodes.end());
    for (auto other = all.begin(); other != all.end();) {
      if (!one_line(line, *other)) {
        ++other;
        continue;
      }
      std::vector<PetscInt> both;
      std::set_union(line.nodes.begin(), line.nodes.end(), other->nodes.begin(), other->nodes.end(),
                     std::back_inserter(both));
      line.nodes = std::move(both);
      line.constrained = line.constrained && other->constrained;
      other = all.erase(other);
    }
    all.push_back(std::move(line));
  }
  return all;
}

/// Lines of one holder that meet at angles, directly or through others; or a single line.
using Rim = std::vector<HingeLine>;

std::vector<Rim> rims_of(const std::vector<HingeLine>& lines) {
  std::vector<Rim> rims;
  for (const HingeLine& line : lines) {
    const auto meets = [&](const HingeLine& other) {
      return !line.holder.empty() && line.holder == other.holder && !in_common(line, other).empty();
    };
    Rim rim{line};
    for (auto other = rims.begin(); other != rims.end();)
      if (std::any_of(other->begin(), other->end(), meets)) {
        rim.insert(rim.end(), other->begin(), other->end());
        other = rims.erase(other);
      } else {
        ++other;
      }
    rims.push_back(std::move(rim));
  }
  return rims;
}

/// The lines of the rim that go through a node.
int lines_through(const Rim& rim, PetscInt node) {
  return static_cast<int>(std::count_if(rim.begin(), rim.end(), [&](const HingeLine& line) {
    return std::binary_search(line.nodes.begin(), line.nodes.end(), node);
  }));
}

std::set<PetscInt> nodes_of(const Rim& rim) {
  std::set<PetscInt> nodes;
  for (const HingeLine& line : rim) nodes.insert(line.nodes.begin(), line.nodes.end());
  return nodes;
}

/// Nodes in common with lines of other rims.
std::set<PetscInt> shared_nodes(const Rim& rim, const std::vector<Rim>& all) {
  std::set<PetscInt> shared;
  const std::set<PetscInt> nodes = nodes_of(rim);
  for (const Rim& other : all)
    if (&other != &rim)
      for (PetscInt node : nodes_of(other))
        if (nodes.contains(node)) shared.insert(node);
  return shared;
}

/// What leads a rim, if not a node of its own choice: more than one where that cannot be.
std::set<PetscInt> independent_nodes_of(const Rim& rim, const std::vector<Rim>& all,
                                        const std::vector<DependentNode>& dependent_nodes) {
  std::set<PetscInt> independent_nodes;
  const auto leads = [&](PetscInt node) {
    return std::any_of(dependent_nodes.begin(), dependent_nodes.end(),
                       [&](const DependentNode& f) { return f.independent_node == node; });
  };
  for (PetscInt node : nodes_of(rim))
    if (const PetscInt independent_node = independent_node_of(dependent_nodes, node);
        independent_node != node || leads(node))
      independent_nodes.insert(independent_node);
  for (PetscInt node : shared_nodes(rim, all)) independent_nodes.insert(independent_node_of(dependent_nodes, node));
  return independent_nodes;
}

/// Whether no node can lead the rim: two would, or a line of another holder pivots about a node of a rim that cannot.
bool is_torn(const Rim& rim, const std::vector<Rim>& all, const std::vector<DependentNode>& dependent_nodes) {
  if (independent_nodes_of(rim, all, dependent_nodes).size() > 1) return true;
  const auto corner = [](const Rim& of) { return of.size() > 1; };
  if (corner(rim)) return !shared_nodes(rim, all).empty();
  return false;
}

bool is_constrained(const Rim& rim) {
  return std::all_of(rim.begin(), rim.end(), [](const HingeLine& line) { return line.constrained; });
}

/// Without those that the ground holds and that cannot be lines beside others.
std::vector<Rim> without_torn(const std::vector<Rim>& rims, const std::vector<DependentNode>& dependent_nodes,
                              std::vector<std::string>* left_out) {
  const auto torn = [&](const Rim& rim) { return is_torn(rim, rims, dependent_nodes); };
  if (std::none_of(rims.begin(), rims.end(), torn)) return rims;
  std::vector<Rim> kept;
  for (const Rim& rim : rims)
    if (!is_constrained(rim) || independent_nodes_of(rim, rims, dependent_nodes).empty())
      kept.push_back(rim);
    else if (left_out)
      for (const HingeLine& line : rim) left_out->push_back(line.where);
  return kept;
}

/// Of a rim that nothing else leads.
PetscInt own_independent_node(const Rim& rim, const std::vector<PetscInt>& preferred) {
  std::vector<PetscInt> candidates;
  for (PetscInt node : nodes_of(rim))
    if (rim.size() == 1 || lines_through(rim, node) > 1) candidates.push_back(node);
  for (PetscInt node : candidates)
    if (std::count(preferred.begin(), preferred.end(), node) > 0) return node;
  return rim.size() == 1 ? candidates[candidates.size() / 2] : candidates.front();
}

}  // namespace

std::vector<DependentNode> with_lines(const std::vector<DependentNode>& dependent_nodes, std::vector<HingeLine> lines,
                                      const std::vector<PetscInt>& preferred, std::vector<std::string>* left_out) {
  std::map<PetscInt, DependentNode> all;
  for (const DependentNode& f : dependent_nodes) all.emplace(f.node, f);
  const std::vector<Rim> rims = without_torn(rims_of(joined(std::move(lines))), dependent_nodes, left_out);
  std::vector<std::string> faults;
  for (const Rim& rim : rims) {
    if (is_torn(rim, rims, dependent_nodes)) {
      for (const HingeLine& line : rim)
        faults.push_back(line.where +
                         ": its edge has nodes in common with two others of joints or links; expected one such node at "
                         "most, or edges: rigid or mean");
      continue;
    }
    const std::set<PetscInt> independent_nodes = independent_nodes_of(rim, rims, dependent_nodes);
    const PetscInt independent_node =
        independent_nodes.empty() ? own_independent_node(rim, preferred) : *independent_nodes.begin();
    for (const HingeLine& line : rim)
      for (PetscInt node : line.nodes)
        if (node != independent_node && independent_node_of(dependent_nodes, node) == node)
          all.emplace(node, lines_through(rim, node) > 1 ? DependentNode{node, independent_node}
                                                         : DependentNode{node, independent_node, line.axis});
  }
  if (!faults.empty()) throw InputError(faults);
  std::vector<DependentNode> ascending;
  for (const auto& [node, dependent_node] : all) ascending.push_back(dependent_node);
  return ascending;
}

}  // namespace floe::mesh
