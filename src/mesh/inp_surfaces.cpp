#include <algorithm>

#include "inp_reading.h"
#include "text.h"

namespace floe::mesh {
namespace {

/// Which nodes of an element a face has: all, or those of the edge 1, 2, ... of a shell, with the middle one. CalculiX
/// numbers the faces of a shell NEG, POS (1, 2) and its edges from 3 on, Abaqus names edges E1, E2, ....
std::vector<int> nodes_of_face(const InpElement& element, const std::string& face) {
  const int corners = element.nodes == 0 ? 0 : corner_count(element.kind);
  int edge = 0;
  if (corners > 2 && face.size() == 2 && face[1] >= '1' && face[1] <= '6') {
    if (face[0] == 'E') edge = face[1] - '0';
    if (face[0] == 'S') edge = face[1] - '2';
  }
  std::vector<int> nodes;
  for (int i = 0; i < element.nodes; ++i)
    if (edge < 1 || i == edge - 1 || i == edge % corners || i == corners + edge - 1) nodes.push_back(i);
  return nodes;
}

}  // namespace

void read_element_surface(const InpBlock& block, InpReading& reading) {
  if (block.parameters.contains("COMBINE"))
    return ignore(block, "only surfaces of nodes and of elements are read", reading);
  InpSurface surface{reading.scopes.own(required(block, "NAME", reading), InpName::surface), block.where, {}};
  std::vector<std::string_view> fields;
  block.each_line([&](Where where, std::string_view line) {
    split_fields(line, fields);
    if (fields.empty() || fields[0].empty()) return;  // all free faces, of contact
    surface.items.push_back({where, reading.scopes.own(std::string(fields[0]), InpName::elements),
                             fields.size() > 1 ? upper(fields[1]) : std::string()});
  });
  if (!surface.name.empty()) reading.surfaces.push_back(std::move(surface));
}

void resolve_surfaces(MPI_Comm comm, InpReading& reading) {
  for (const InpSurface& surface : reading.surfaces)  // of nodes
    if (surface.set >= 0 && reading.node_sets.find(surface.name) < 0)
      reading.node_sets.sets[surface.set].name = surface.name;
  std::vector<InpElementList> lists;
  std::vector<std::pair<std::size_t, std::string>> origins;  // surface and face of each list
  for (std::size_t s = 0; s < reading.surfaces.size(); ++s) {
    for (const auto& item : reading.surfaces[s].items) {
      InpElementList list{{}, {}, "surface " + reading.surfaces[s].name, item.where};
      const auto label = number<long long>(item.elements);
      const int set = label ? -1 : reading.element_sets.find(item.elements);
      if (label && reading.rank == 0) list.labels = {*label};
      if (set >= 0) list.sets = reading.element_sets.with_members(set);
      if (!label && set < 0)
        reading.faults.add(item.where, "there is no element set " + in_quotes(item.elements) +
                                           suggestion(item.elements, reading.element_sets.names()));
      lists.push_back(std::move(list));
      origins.emplace_back(s, item.face);
    }
  }
  std::vector<std::vector<long long>> labels(reading.surfaces.size());
  for (const auto& [element, list] : members_of(comm, lists, reading)) {
    const auto& [surface, face] = origins[list];
    const InpElement& of = reading.elements[element];
    for (const int i : nodes_of_face(of, face)) labels[surface].push_back(of.node_labels[i]);
  }
  std::vector<long long> counts;
  for (const auto& one : labels) counts.push_back(static_cast<long long>(one.size()));
  MPI_Allreduce(MPI_IN_PLACE, counts.data(), static_cast<int>(counts.size()), MPI_LONG_LONG, MPI_SUM, comm);
  for (std::size_t s = 0; s < labels.size(); ++s) {
    if (counts[s] == 0) continue;  // of solids that are left out
    auto& surface = reading.surfaces[s];
    const bool taken = reading.node_sets.find(surface.name) >= 0;
    surface.set = reading.node_sets.named(surface.name + (taken ? " (surface)" : ""), surface.where);
    auto& own = reading.node_sets.sets[surface.set].labels;
    own.insert(own.end(), labels[s].begin(), labels[s].end());
  }
}

}  // namespace floe::mesh
