#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "floe/petsc/all_ranks.h"
#include "inp_reading.h"
#include "text.h"

namespace floe::mesh {
namespace {

// The node that a text names: its number, or the only one of a set. Collective.
std::optional<long long> one_node(MPI_Comm comm, const std::string& text, Where where, InpReading& reading) {
  if (const auto label = number<long long>(reading.scopes.own(text, InpName::nodes))) return label;
  const int set = reading.node_sets.find(reading.scopes.own(text, InpName::nodes));
  if (set < 0) {
    reading.faults.add(where, "there is no node set " + in_quotes(text) + suggestion(text, reading.node_sets.names()));
    return std::nullopt;
  }
  const auto& labels = reading.mesh.places[set].labels;
  long long range[2] = {labels.empty() ? std::numeric_limits<long long>::max() : labels.front(),
                        labels.empty() ? std::numeric_limits<long long>::max() : -labels.back()};
  MPI_Allreduce(MPI_IN_PLACE, range, 2, MPI_LONG_LONG, MPI_MIN, comm);
  if (range[0] == -range[1]) return range[0];
  reading.faults.add(where, "expected a node set of one node, found " + in_quotes(text));
  return std::nullopt;
}

/// The set of nodes that a text names: a surface before a node set, unless `set_first`; -1: none, a fault.
int set_named(const std::string& text, Where where, InpReading& reading, bool set_first = false) {
  const std::string name = reading.scopes.own(text, InpName::nodes),
                    of_surface = reading.scopes.own(text, InpName::surface);
  if (const int set = reading.node_sets.find(name); set_first && set >= 0) return set;
  for (const auto& surface : reading.surfaces) {
    if (upper(surface.name) != upper(of_surface)) continue;
    if (surface.set < 0) reading.faults.add(where, surface.name + " has no nodes of beams or shells");
    return surface.set;
  }
  const int set = reading.node_sets.find(name);
  if (set >= 0) return set;
  std::vector<std::string> known = reading.node_sets.names();
  for (const auto& surface : reading.surfaces) known.push_back(surface.name);
  reading.faults.add(where, "there is no node set or surface " + in_quotes(text) + suggestion(text, known));
  return -1;
}

}  // namespace

void add_link(long long reference, const std::vector<long long>& labels, Where where, InpReading& reading,
              const RigidLink& free) {
  auto& mesh = reading.mesh;
  RigidLink rigid = free;
  rigid.reference = static_cast<PetscInt>(mesh.mentions.size());
  mesh.mentions.push_back({reference, where});
  for (const long long label : labels) {
    if (label == reference) continue;
    rigid.nodes.push_back(static_cast<PetscInt>(mesh.mentions.size()));
    mesh.mentions.push_back({label, where});
  }
  reading.deck.links.push_back(std::move(rigid));
}

namespace {

struct Labelled {
  long long label;
  double x[3];
};

/// Those of the nodes, ascending by label, each once, the same on all ranks. Collective.
std::vector<Labelled> with_positions(MPI_Comm comm, const std::vector<long long>& labels, const InpReading& reading) {
  std::vector<Labelled> mine;
  for (const auto& [label, x] : positions_of(comm, labels, reading)) mine.push_back({label, {x[0], x[1], x[2]}});
  std::vector<Labelled> all = petsc::of_all_ranks(comm, mine);
  const auto less = [](const Labelled& a, const Labelled& b) { return a.label < b.label; };
  std::sort(all.begin(), all.end(), less);
  all.erase(std::unique(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.label == b.label; }),
            all.end());
  return all;
}

double distance(const Labelled& a, const Labelled& b) {
  return std::hypot(a.x[0] - b.x[0], a.x[1] - b.x[1], a.x[2] - b.x[2]);
}

/// Greatest distance from the first: a length of the set.
double size_of(const std::vector<Labelled>& nodes) {
  double size = 0;
  for (const auto& node : nodes) size = std::max(size, distance(node, nodes.front()));
  return size;
}

Labelled mean_of(const std::vector<Labelled>& nodes) {
  Labelled mean{0, {0, 0, 0}};
  for (const auto& node : nodes)
    for (int i = 0; i < 3; ++i) mean.x[i] += node.x[i] / static_cast<double>(nodes.size());
  return mean;
}

constexpr double near_enough = 1e-6;  // of the size of the set

/// *MPC TIE and PIN: all nodes at the place of the reference node. Collective.
void refuse_distant(MPI_Comm comm, const InpLink& link, long long reference, const std::vector<long long>& labels,
                    InpReading& reading) {
  const auto base = with_positions(comm, {reference}, reading), others = with_positions(comm, labels, reading);
  const Labelled origin{0, {0, 0, 0}};
  for (const auto& node : others)
    if (!base.empty() && distance(node, base[0]) > near_enough * distance(node, origin))
      reading.faults.add(link.where, std::string("*MPC ") + (link.free.others ? "PIN" : "TIE") + " of nodes " +
                                         std::to_string(node.label) + " and " + std::to_string(reference) +
                                         " at different points is not read; expected BEAM" +
                                         (link.free.others ? ", or *RIGID BODY with PIN NSET" : ""));
}

/// Whether shells have one of the nodes. Collective.
bool has_shells(MPI_Comm comm, const std::vector<Labelled>& nodes, const InpReading& reading) {
  const auto among = [&](long long label) {
    const auto found = std::lower_bound(nodes.begin(), nodes.end(), label,
                                        [](const Labelled& node, long long sought) { return node.label < sought; });
    return found != nodes.end() && found->label == label;
  };
  int any = std::any_of(reading.mesh.cells.begin(), reading.mesh.cells.end(), [&](const auto& cell) {
    return is_shell(cell.kind) && std::any_of(cell.nodes.begin(), cell.nodes.begin() + node_count(cell.kind), among);
  });
  MPI_Allreduce(MPI_IN_PLACE, &any, 1, MPI_INT, MPI_MAX, comm);
  return any != 0;
}

/// A mean of nodes cannot carry what else its reference node has: it becomes a notice where that is nothing.
/// Collective.
void leave_out_mean(MPI_Comm comm, const InpLink& link, long long reference, int set, InpReading& reading) {
  const std::vector<Labelled> base = with_positions(comm, {reference}, reading);
  if (base.empty())
    return reading.faults.add(link.where,
                              "this line names node " + std::to_string(reference) + ", which is not defined");
  int used = 0;
  for (const auto& cell : reading.mesh.cells)
    used += std::count(cell.nodes.begin(), cell.nodes.begin() + node_count(cell.kind), reference) > 0;
  for (const auto& mention : reading.mesh.mentions) used += mention.label == reference;
  MPI_Allreduce(MPI_IN_PLACE, &used, 1, MPI_INT, MPI_SUM, comm);
  const std::string node = "reference node " + std::to_string(reference), place = reading.node_sets.sets[set].name;
  const std::vector<Labelled> nodes = with_positions(comm, reading.mesh.places[set].labels, reading);
  const double apart = distance(base.front(), mean_of(nodes));
  if (used > 0)
    return reading.faults.add(link.where,
                              "*COUPLING with *DISTRIBUTING: " + node +
                                  " has an element, a mass or a link, which a mean of nodes does not carry; "
                                  "expected *KINEMATIC");
  if (!has_shells(comm, nodes, reading)) {  // it rotates by displacements, as RBE3; places on shells do anyway
    auto& mean = reading.mesh.places[set];
    mean.labels.clear();  // several ranks may have found one
    if (reading.rank == 0)
      for (const Labelled& one : nodes) mean.labels.push_back(one.label);
    mean.weighted = true, mean.weights.assign(mean.labels.size(), 1);
  }
  reading.notices.push_back(
      reading.faults.text_of(link.where) + ": *COUPLING with *DISTRIBUTING is ignored: " + node + " has no element; " +
      (apart > near_enough * size_of(nodes)
           ? "it is " + fmt::format("{:.3g}", apart) + " away from the mean of the nodes of the place " + place +
                 ": a force there is one on this place, with its moment about the mean"
           : "its motion is the mean of the place " + place));
}

/// Collective.
void tie(MPI_Comm comm, const InpTie& given, InpReading& reading) {
  const int dependent = set_named(given.dependent, given.where, reading),
            independent = set_named(given.independent, given.where, reading);
  if (dependent < 0 || independent < 0) return;
  const auto first = with_positions(comm, reading.mesh.places[dependent].labels, reading),
             second = with_positions(comm, reading.mesh.places[independent].labels, reading);
  const double limit = near_enough * std::max(size_of(first), size_of(second));
  std::vector<std::array<long long, 2>> pairs;  // reference, dependent
  long long apart = 0;
  for (const auto& node : first) {
    const auto nearest = std::min_element(second.begin(), second.end(), [&](const auto& a, const auto& b) {
      return distance(a, node) < distance(b, node);
    });
    if (nearest == second.end() || distance(*nearest, node) > limit)
      ++apart;
    else if (nearest->label != node.label)
      pairs.push_back({nearest->label, node.label});
  }
  const std::string where =
      reading.faults.text_of(given.where) + ": *TIE of " + given.dependent + " to " + given.independent;
  if (apart > 0) {
    reading.notices.push_back(where + " is ignored: " + std::to_string(apart) + " of " +
                              counted(static_cast<long long>(first.size()), "node") +
                              " coincide with no node of the other surface");
    return;
  }
  RigidLink free{};
  free.others = given.free;
  for (const auto& [reference, node] : pairs)
    add_link(reference, reading.rank == 0 ? std::vector{node} : std::vector<long long>{}, given.where, reading, free);
  reading.notices.push_back(where + ": " + counted(static_cast<long long>(pairs.size()), "node") +
                            " rigidly linked to the nodes at the same points" +
                            (given.free ? ", with rotations of their own (NO ROTATION)" : ""));
}

}  // namespace

void resolve_links(MPI_Comm comm, InpReading& reading) {
  std::vector<std::tuple<const InpLink*, long long, int>> means;  // reference and set of each
  for (const auto& link : reading.links) {
    const auto reference = one_node(comm, link.reference, link.where, reading);
    const auto node = number<long long>(reading.scopes.own(link.nodes, InpName::nodes));
    const int set =
        node && link.kind != InpLink::mean ? -1 : set_named(link.nodes, link.where, reading, link.set_first);
    if (!reference || (set < 0 && (!node || link.kind == InpLink::mean))) continue;
    if (link.kind == InpLink::mean) {
      means.push_back({&link, *reference, set});
      continue;
    }
    std::vector<long long> labels;
    if (set >= 0) labels = reading.mesh.places[set].labels;
    if (node && reading.rank == 0) labels = {*node};
    if (link.kind == InpLink::equal) refuse_distant(comm, link, *reference, labels, reading);
    add_link(*reference, labels, link.where, reading, link.free);
  }
  for (const auto& one : reading.ties) tie(comm, one, reading);
  for (const auto& [link, reference, set] : means) leave_out_mean(comm, *link, reference, set, reading);
}

}  // namespace floe::mesh
