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

namespace {

std::vector<PetscInt> in_common(const HingeLine& one, const HingeLine& other) {
  std::vector<PetscInt> both;
  std::set_intersection(one.nodes.begin(), one.nodes.end(), other.nodes.begin(), other.nodes.end(),
                        std::back_inserter(both));
  return both;
}

/// Lines with two nodes in common made one; nodes ascend.
std::vector<HingeLine> joined(std::vector<HingeLine> lines) {
  std::vector<HingeLine> all;
  for (HingeLine& line : lines) {
    std::sort(line.nodes.begin(), line.nodes.end());
    for (auto other = all.begin(); other != all.end();) {
      if (in_common(line, *other).size() < 2) {
        ++other;
        continue;
      }
      std::vector<PetscInt> both;
      std::set_union(line.nodes.begin(), line.nodes.end(), other->nodes.begin(), other->nodes.end(),
                     std::back_inserter(both));
      line.nodes = std::move(both);
      line.held = line.held && other->held;
      other = all.erase(other);
    }
    all.push_back(std::move(line));
  }
  return all;
}

}  // namespace

namespace {

/// What leads a line, if not a node of its own choice: more than one where that cannot be.
std::set<PetscInt> leaders_of(const HingeLine& line, const std::vector<HingeLine>& all,
                              const std::vector<Follower>& followers) {
  std::set<PetscInt> leaders;
  const auto leads = [&](PetscInt node) {
    return std::any_of(followers.begin(), followers.end(), [&](const Follower& f) { return f.leader == node; });
  };
  for (PetscInt node : line.nodes)
    if (const PetscInt leader = leader_of(followers, node); leader != node || leads(node)) leaders.insert(leader);
  for (const HingeLine& other : all)
    if (&other != &line)
      for (PetscInt node : in_common(line, other)) leaders.insert(leader_of(followers, node));
  return leaders;
}

/// Whether the ground holds the line and another one that meets it at an angle.
bool crosses_held(const HingeLine& line, const std::vector<HingeLine>& all) {
  const auto angle = [&](const HingeLine& other) {
    const Eigen::Map<const Eigen::Vector3d> a(line.axis.data()), b(other.axis.data());
    return a.cross(b).norm();
  };
  return line.held && std::any_of(all.begin(), all.end(), [&](const HingeLine& other) {
           return &other != &line && other.held && angle(other) > 1e-6 && !in_common(line, other).empty();
         });
}

/// Without those that the ground holds and that cannot be lines beside others.
std::vector<HingeLine> without_torn(const std::vector<HingeLine>& lines, const std::vector<Follower>& followers,
                                    std::vector<std::string>* left_out) {
  std::vector<HingeLine> apart, kept;
  const auto leave_out = [&](const HingeLine& line) {
    if (left_out) left_out->push_back(line.where);
  };
  for (const HingeLine& line : lines)
    if (crosses_held(line, lines))
      leave_out(line);
    else
      apart.push_back(line);
  const auto torn = [&](const HingeLine& line) { return leaders_of(line, apart, followers).size() > 1; };
  if (std::none_of(apart.begin(), apart.end(), torn)) return apart;
  for (const HingeLine& line : apart)
    if (!line.held || leaders_of(line, apart, followers).empty())
      kept.push_back(line);
    else
      leave_out(line);
  return kept;
}

}  // namespace

std::vector<Follower> with_lines(const std::vector<Follower>& followers, std::vector<HingeLine> lines,
                                 const std::vector<PetscInt>& preferred, std::vector<std::string>* left_out) {
  std::map<PetscInt, Follower> all;
  for (const Follower& f : followers) all.emplace(f.node, f);
  lines = without_torn(joined(std::move(lines)), followers, left_out);
  std::vector<std::string> faults;
  for (const HingeLine& line : lines) {
    std::set<PetscInt> leaders = leaders_of(line, lines, followers);
    if (leaders.size() > 1) {
      faults.push_back(line.where +
                       ": its edge has nodes in common with two others that joints or links hold; expected one such "
                       "node at most, or edges: rigid or mean");
      continue;
    }
    for (PetscInt node : line.nodes)
      if (leaders.empty() && std::count(preferred.begin(), preferred.end(), node) > 0) leaders.insert(node);
    const PetscInt leader = leaders.empty() ? line.nodes[line.nodes.size() / 2] : *leaders.begin();
    for (PetscInt node : line.nodes)
      if (node != leader && leader_of(followers, node) == node) all.emplace(node, Follower{node, leader, line.axis});
  }
  if (!faults.empty()) throw InputError(faults);
  std::vector<Follower> ascending;
  for (const auto& [node, follower] : all) ascending.push_back(follower);
  return ascending;
}

}  // namespace floe::mesh
