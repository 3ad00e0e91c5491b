#include <algorithm>

#include "inp_reading.h"
#include "text.h"

namespace floe::mesh {
namespace {

bool fits(const InpElement& element, InpUse::Kind kind) {
  if (element.kind == CellKind::point) return kind == InpUse::mass;
  if (element.kind == CellKind::spring) return kind == InpUse::spring;
  return kind == InpUse::scene || kind == (is_line(element.kind) ? InpUse::beam : InpUse::shell);
}

void assign(InpElement& element, int use, const InpReading& reading) {
  if (element.nodes == 0) return;
  if (!fits(element, reading.uses[use].kind)) {
    element.other_use = std::max(element.other_use, use);
    return;
  }
  element.again = element.again || (element.use >= 0 && element.use != use);
  element.use = std::max(element.use, use);
}

void refuse_unused(const InpElement& element, InpReading& reading) {
  const std::string needed = element.kind == CellKind::point    ? "*MASS"
                             : element.kind == CellKind::spring ? "*SPRING"
                             : is_line(element.kind)            ? "*BEAM SECTION"
                                                                : "*SHELL SECTION";
  if (element.other_use >= 0)
    return reading.faults.add(element.where, "element " + std::to_string(element.label) + " needs a " + needed +
                                                 ", set " + in_quotes(reading.uses[element.other_use].set) +
                                                 " has another section");
  const bool by_scene = has_extent(element.kind) && (reading.request.section || !reading.request.parts.empty());
  if (!by_scene)
    reading.faults.add(element.where,
                       "element " + std::to_string(element.label) + " has no section: it is in no set of a " + needed);
}

/// Sections by which earlier ones of the same elements do not hold. Collective.
void report_overridden(MPI_Comm comm, InpReading& reading) {
  std::vector<long long> counts(reading.uses.size(), 0);
  for (const auto& element : reading.elements)
    if (element.again) ++counts[element.use];
  MPI_Allreduce(MPI_IN_PLACE, counts.data(), static_cast<int>(counts.size()), MPI_LONG_LONG, MPI_SUM, comm);
  for (std::size_t use = 0; use < counts.size(); ++use)
    if (counts[use] > 0 && reading.uses[use].kind != InpUse::scene)
      reading.notices.push_back(reading.faults.text_of(reading.uses[use].where) + ": set " + reading.uses[use].set +
                                " overrides an earlier section of " + counted(counts[use], "element"));
}

/// Parts of the elements that have no section, by their *ELEMENT, ELSET=; of each element set, and last of none: the
/// part's number, or -1. Collective.
std::vector<int> parts_without_section(MPI_Comm comm, InpReading& reading) {
  const std::size_t sets = reading.element_sets.sets.size();
  std::vector<int> parts(sets + 1, 0);
  for (const auto& element : reading.elements)
    if (element.nodes > 1 && has_extent(element.kind) && element.use < 0)
      parts[element.set < 0 ? sets : static_cast<std::size_t>(element.set)] = 1;
  MPI_Allreduce(MPI_IN_PLACE, parts.data(), static_cast<int>(parts.size()), MPI_INT, MPI_MAX, comm);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const bool needed = parts[i] > 0;
    parts[i] = needed ? static_cast<int>(reading.mesh.parts.size()) : -1;
    if (needed) reading.mesh.parts.push_back(i < sets ? reading.element_sets.sets[i].name : "mesh");
  }
  return parts;
}

/// Sets that the scene gives a section, after those of the deck.
void add_requested(InpReading& reading) {
  for (const auto& given : reading.request.parts) {
    const std::string name = reading.scopes.own(given, InpName::elements);
    const bool own = std::any_of(reading.uses.begin(), reading.uses.end(), [&](const InpUse& use) {
      return use.kind != InpUse::mass && use.kind != InpUse::spring && upper(use.set) == upper(name);
    });
    if (!own && reading.element_sets.find(name) >= 0)
      reading.uses.push_back(
          {InpUse::scene, reading.element_sets.sets[reading.element_sets.find(name)].name, {0, 1}, 0});
  }
}

// The elements of each use; names that are no sets become faults.
std::vector<InpElementList> elements_of_uses(InpReading& reading) {
  std::vector<InpElementList> lists;
  for (const auto& use : reading.uses) {
    const int set = reading.element_sets.find(use.set);
    if (set < 0)
      reading.faults.add(use.where, "there is no element set " + in_quotes(use.set) +
                                        suggestion(use.set, reading.element_sets.names()));
    lists.push_back({set < 0 ? std::vector<int>{} : reading.element_sets.with_members(set), {}, use.set, use.where});
  }
  return lists;
}

}  // namespace

void assign_sections(MPI_Comm comm, InpReading& reading) {
  add_requested(reading);
  for (const auto& [element, use] : members_of(comm, elements_of_uses(reading), reading))
    assign(reading.elements[element], use, reading);

  auto& mesh = reading.mesh;
  std::vector<int> part_of(reading.uses.size(), -1);
  for (std::size_t use = 0; use < reading.uses.size(); ++use) {
    if (reading.uses[use].kind == InpUse::mass || reading.uses[use].kind == InpUse::spring) continue;
    part_of[use] = static_cast<int>(mesh.parts.size());
    mesh.parts.push_back(reading.uses[use].set);
  }
  report_overridden(comm, reading);
  const std::vector<int> without = parts_without_section(comm, reading);
  for (const auto& element : reading.elements) {
    if (element.nodes == 0) continue;
    if (element.use < 0) refuse_unused(element, reading);
    if (element.nodes == 1) {
      if (element.use < 0) continue;
      reading.deck.masses.push_back({static_cast<PetscInt>(mesh.mentions.size()), reading.uses[element.use].amount});
      mesh.mentions.push_back({element.node_labels[0], element.where});
      mesh.masses.push_back({element.label, element.where});
    } else if (element.kind == CellKind::spring) {
      if (element.use < 0) continue;
      reading.springs.push_back(
          {element.label, {element.node_labels[0], element.node_labels[1]}, element.use, element.axial, element.where});
      mesh.masses.push_back({element.label, element.where});
    } else {
      const int part = element.use >= 0  ? part_of[element.use]
                       : element.set < 0 ? without.back()
                                         : without[element.set];
      mesh.cells.push_back({element.label, element.kind, part, element.node_labels, element.where});
    }
  }
}

}  // namespace floe::mesh
