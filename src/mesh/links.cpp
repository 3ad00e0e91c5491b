#include "floe/mesh/links.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <tuple>

#include "floe/error.h"
#include "floe/mesh/exchange.h"
#include "floe/petsc/all_ranks.h"

namespace floe::mesh {
namespace {

/// Labels of nodes, in their order. Collective; `nodes` the same on all ranks.
std::vector<long long> labels_of(const RawMesh& mesh, const std::vector<PetscInt>& nodes) {
  const std::vector<PetscInt> starts = starts_of(mesh.comm, static_cast<PetscInt>(mesh.positions.size()));
  return ask<long long>(
      mesh.comm, nodes, [&](PetscInt node) { return owner_of(starts, node); },
      [&](PetscInt node) { return mesh.node_labels[node - mesh.first_node]; });
}

/// Positions of nodes, in their order. Collective; `nodes` the same on all ranks.
std::vector<Eigen::Vector3d> positions_of(const RawMesh& mesh, const std::vector<PetscInt>& nodes) {
  const std::vector<PetscInt> starts = starts_of(mesh.comm, static_cast<PetscInt>(mesh.positions.size()));
  std::vector<Eigen::Vector3d> all;
  for (const auto& x : ask<std::array<double, 3>>(
           mesh.comm, nodes, [&](PetscInt node) { return owner_of(starts, node); },
           [&](PetscInt node) {
             const Eigen::Vector3d& at = mesh.positions[node - mesh.first_node];
             return std::array<double, 3>{at[0], at[1], at[2]};
           }))
    all.emplace_back(x[0], x[1], x[2]);
  return all;
}

bool before(const DependentNode& a, PetscInt node) { return a.node < node; }

const DependentNode* find(const std::vector<DependentNode>& all, PetscInt node) {
  const auto found = std::lower_bound(all.begin(), all.end(), node, before);
  return found != all.end() && found->node == node ? &*found : nullptr;
}

/// Points of the nodes of links that leave rotations free, and of those that these depend on.
struct Points {
  std::map<PetscInt, Eigen::Vector3d> x;
  double small = 0;  ///< the distance of nodes at one point
  bool one(PetscInt a, PetscInt b) const { return (x.at(a) - x.at(b)).norm() <= small; }
};

/// Collective.
Points points_of(const RawMesh& mesh, const std::vector<DependentNode>& all) {
  std::vector<PetscInt> nodes;
  for (const DependentNode& link : all)
    if (link.spins()) nodes.insert(nodes.end(), {link.node, link.independent_node});
  const std::vector<Eigen::Vector3d> x = positions_of(mesh, nodes);
  Points points;
  for (std::size_t i = 0; i < nodes.size(); ++i) points.x[nodes[i]] = x[i];
  for (const Eigen::Vector3d& at : mesh.positions)
    points.small = std::max(points.small, 1e-9 * at.cwiseAbs().maxCoeff());
  MPI_Allreduce(MPI_IN_PLACE, &points.small, 1, MPI_DOUBLE, MPI_MAX, mesh.comm);
  return points;
}

/// Nodes whose dependence leads back to them; nodes that follow one with rotations of its own.
struct Chains {
  std::vector<PetscInt> round, loose;
};

/// A node whose independent node depends on another one moves with that one: rigid links compose. Those that leave
/// rotations free do so only at one point, with the same ones free.
Chains follow_chains(std::vector<DependentNode>& all, const Points& points) {
  const std::vector<DependentNode> given = all;
  Chains chains;
  for (DependentNode& link : all) {
    for (std::size_t steps = 0; steps <= given.size(); ++steps) {
      const DependentNode* next = find(given, link.independent_node);
      if (!next) break;
      const bool alike = next->others == link.others && next->axis == link.axis;
      if (next->spins() && !(alike && points.one(link.node, next->node))) {
        chains.loose.push_back(link.node);
        break;
      }
      link.independent_node = next->independent_node;
      if (link.independent_node != link.node) continue;
      chains.round.push_back(link.node);
      break;
    }
  }
  return chains;
}

/// Those of a link's nodes that some rank lists, ascending, the same on all ranks. Collective.
std::vector<PetscInt> of_links(const RawMesh& mesh, const std::vector<DependentNode>& all, std::vector<PetscInt> mine) {
  std::set<PetscInt> linked;
  for (const DependentNode& link : all) linked.insert({link.node, link.independent_node});
  std::erase_if(mine, [&](PetscInt node) { return !linked.contains(node); });
  const auto sort = [](std::vector<PetscInt>& nodes) {
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  };
  sort(mine);
  std::vector<PetscInt> found = petsc::of_all_ranks(mesh.comm, mine);
  sort(found);
  return found;
}

/// What acts on the nodes of links.
struct Acting {
  std::vector<PetscInt> resisted;  ///< rotations that beams, shells, springs or moments of inertia resist
  std::vector<PetscInt> heavy;     ///< with other point masses
};

/// Collective.
Acting acting_on(const RawMesh& mesh, const Deck& deck, const std::vector<DependentNode>& all) {
  std::vector<PetscInt> resisted, heavy;
  for (const Cell& cell : mesh.cells)
    if (has_extent(cell.kind))
      resisted.insert(resisted.end(), cell.nodes.begin(), cell.nodes.begin() + node_count(cell.kind));
  for (const NodeSpring& spring : deck.springs)  // one along its nodes' line, or at their point, has no moment
    if (std::any_of(spring.stiffness.begin() + 3, spring.stiffness.end(), [](double k) { return k != 0; }) ||
        std::count(spring.stiffness.begin(), spring.stiffness.begin() + 3, 0.0) < 2)
      resisted.insert(resisted.end(), spring.nodes.begin(), spring.nodes.end());
  for (const PointMass& mass : deck.masses)
    (mass.inertia.isZero(0) && mass.offset.isZero(0) ? heavy : resisted).push_back(mass.node);
  return {of_links(mesh, all, std::move(resisted)), of_links(mesh, all, std::move(heavy))};
}

/// The direction of the line through the nodes; zero: they are at one point, none: on no line.
std::optional<Eigen::Vector3d> line_of(const std::vector<DependentNode*>& links, const Points& points) {
  const Eigen::Vector3d& from = points.x.at(links[0]->node);
  Eigen::Vector3d far = Eigen::Vector3d::Zero();
  for (const DependentNode* link : links)
    if (const Eigen::Vector3d d = points.x.at(link->node) - from; d.norm() > far.norm()) far = d;
  if (far.norm() <= points.small) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d along = far.normalized();
  for (const DependentNode* link : links)
    if ((points.x.at(link->node) - from).cross(along).norm() > 1e-6 * far.norm()) return std::nullopt;
  return along;
}

/// Free rotations that nothing resists follow the link: those of dependent nodes, and those of independent nodes
/// without mass, of which their dependent nodes leave all free where they are at one point, and one where they are on a
/// line.
void tie_idle_rotations(std::vector<DependentNode>& all, const Points& points, const Acting& acting) {
  const auto has = [](const std::vector<PetscInt>& nodes, PetscInt node) {
    return std::binary_search(nodes.begin(), nodes.end(), node);
  };
  std::map<PetscInt, std::vector<DependentNode*>> lone;  // by independent node
  std::set<PetscInt> firm;
  for (DependentNode& link : all) {
    if (!has(acting.resisted, link.node)) link.axis = {}, link.others = false;
    const bool heavy_arm = !link.spins() && has(acting.heavy, link.node);
    if (has(acting.resisted, link.independent_node) || (!link.spins() && has(acting.resisted, link.node)) || heavy_arm)
      firm.insert(link.independent_node);
    if (link.spins()) lone[link.independent_node].push_back(&link);
  }
  for (const auto& [node, links] : lone) {
    const DependentNode& first = *links.front();
    if (firm.contains(node) || std::any_of(links.begin(), links.end(), [&](const DependentNode* link) {
          return link->others != first.others || link->axis != first.axis;
        }))
      continue;
    const std::optional<Eigen::Vector3d> line = line_of(links, points);
    const bool heavy = has(acting.heavy, node), at_node = points.one(node, first.node);
    if (!line || (heavy && !at_node)) continue;
    if (line->isZero(0))
      links.front()->axis = {}, links.front()->others = false;
    else if (first.others && first.axis == std::array<double, 3>{} && !heavy)
      Eigen::Vector3d::Map(links.front()->axis.data()) = *line;
  }
}

}  // namespace

std::vector<DependentNode> with_independent_elements(const RawMesh& mesh, std::vector<DependentNode> all,
                                                     const std::vector<PetscInt>& kept) {
  std::vector<PetscInt> used;
  for (const Cell& cell : mesh.cells)
    if (has_extent(cell.kind)) used.insert(used.end(), cell.nodes.begin(), cell.nodes.begin() + node_count(cell.kind));
  const std::vector<PetscInt> with_elements = of_links(mesh, all, std::move(used));
  const auto has = [](const std::vector<PetscInt>& nodes, PetscInt node) {
    return std::find(nodes.begin(), nodes.end(), node) != nodes.end();
  };
  std::map<PetscInt, std::vector<PetscInt>> regions;  // nodes with elements, by the independent node
  std::set<PetscInt> loose;
  for (const DependentNode& link : all) {
    if (link.spins()) loose.insert(link.independent_node);
    if (has(with_elements, link.node)) regions[link.independent_node].push_back(link.node);
  }
  std::map<PetscInt, PetscInt> independent;
  for (const auto& [node, others] : regions) {
    if (others.empty() || loose.contains(node) || has(with_elements, node) || has(kept, node)) continue;
    const std::vector<Eigen::Vector3d> x = positions_of(mesh, others);
    const double small = 1e-9 * x.front().norm();
    if (std::all_of(x.begin(), x.end(), [&](const Eigen::Vector3d& at) { return (at - x.front()).norm() <= small; }))
      independent[node] = others.front();
  }
  for (DependentNode& link : all) {
    const auto found = independent.find(link.independent_node);
    if (found == independent.end()) continue;
    if (link.node == found->second) link.node = found->first;
    link.independent_node = found->second;
  }
  std::sort(all.begin(), all.end(), [](const DependentNode& a, const DependentNode& b) { return a.node < b.node; });
  return all;
}

PetscInt independent_node_of(const std::vector<DependentNode>& dependent_nodes, PetscInt node) {
  const DependentNode* found = find(dependent_nodes, node);
  return found ? found->independent_node : node;
}

std::vector<DependentNode> dependent_nodes(const RawMesh& mesh, const Deck& deck) {
  std::vector<DependentNode> mine;
  for (const RigidLink& link : deck.links)
    for (PetscInt node : link.nodes)
      if (node != link.reference) mine.push_back({node, link.reference, link.axis, link.others});
  std::vector<DependentNode> all = petsc::of_all_ranks(mesh.comm, mine);
  const auto key = [](const DependentNode& a) { return std::tuple(a.node, a.independent_node, a.axis, a.others); };
  std::sort(all.begin(), all.end(), [&](const DependentNode& a, const DependentNode& b) { return key(a) < key(b); });
  all.erase(std::unique(all.begin(), all.end(),
                        [&](const DependentNode& a, const DependentNode& b) { return key(a) == key(b); }),
            all.end());
  std::vector<PetscInt> twice;
  for (std::size_t i = 1; i < all.size(); ++i)
    if (all[i].node == all[i - 1].node) twice.push_back(all[i].node);
  const bool free = std::any_of(all.begin(), all.end(), [](const DependentNode& link) { return link.spins(); });
  const Points points = free ? points_of(mesh, all) : Points{};
  const auto [round, loose] = follow_chains(all, points);
  if (free && round.empty() && loose.empty() && twice.empty())
    tie_idle_rotations(all, points_of(mesh, all), acting_on(mesh, deck, all));
  std::vector<std::string> faults;
  for (long long label : labels_of(mesh, twice))
    faults.push_back(fmt::format("{}: node {} is in rigid links to two nodes; expected one", mesh.source, label));
  for (long long label : labels_of(mesh, round))
    faults.push_back(fmt::format("{}: rigid links lead from node {} back to it; expected one that depends on no other",
                                 mesh.source, label));
  for (long long label : labels_of(mesh, loose))
    faults.push_back(
        fmt::format("{}: node {} depends on a node whose rotations another link leaves free; expected an independent "
                    "node that depends on no other, or on another one in all directions",
                    mesh.source, label));
  if (!faults.empty()) throw InputError(faults);
  return all;
}

}  // namespace floe::mesh
