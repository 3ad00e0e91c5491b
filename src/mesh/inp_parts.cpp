#include <algorithm>

#include "floe/mesh/exchange.h"
#include "floe/mesh/labels.h"
#include "inp_reading.h"
#include "text.h"

namespace floe::mesh {
namespace {

struct Assignment {
  PetscInt element;
  int use;
};

// Elements that the sets list by number, told to the ranks that hold them. Collective.
std::vector<Assignment> listed_elements(MPI_Comm comm, const std::vector<std::vector<int>>& sets_of_uses,
                                        InpReading& reading) {
  std::vector<long long> labels, asked;
  for (const auto& element : reading.elements) labels.push_back(element.label);
  std::vector<std::pair<int, int>> origins;  // use, set
  for (std::size_t use = 0; use < sets_of_uses.size(); ++use)
    for (const int set : sets_of_uses[use])
      for (const long long label : reading.element_sets.sets[set].labels) {
        asked.push_back(label);
        origins.emplace_back(static_cast<int>(use), set);
      }
  const LabelDirectory directory(comm, labels);
  const auto found = directory.find(asked);
  std::vector<Assignment> assignments;
  for (std::size_t i = 0; i < asked.size(); ++i) {
    const auto& set = reading.element_sets.sets[origins[i].second];
    if (found[i] < 0)
      reading.faults.add(set.where, "element set " + set.name + " names element " + std::to_string(asked[i]) +
                                        ", which is not defined");
    else
      assignments.push_back({found[i], origins[i].first});
  }
  const auto starts = starts_of(comm, static_cast<PetscInt>(labels.size()));
  auto received = scatter(comm, assignments, [&](const Assignment& a) { return owner_of(starts, a.element); }).values;
  for (auto& a : received) a.element -= directory.first();
  return received;
}

void assign(InpElement& element, int use, InpReading& reading) {
  if (element.use >= 0 && element.use != use)
    return reading.faults.add(element.where, "element " + std::to_string(element.label) + " is in two sections, of " +
                                                 in_quotes(reading.uses[element.use].set) + " and " +
                                                 in_quotes(reading.uses[use].set));
  element.use = use;
}

void refuse_wrong_use(const InpElement& element, InpReading& reading) {
  static const char* const needs[] = {"", "*MASS", "*BEAM SECTION", "*SHELL SECTION", "*SHELL SECTION"};
  const int kind = element.nodes == 1 ? InpUse::mass : element.nodes == 2 ? InpUse::beam : InpUse::shell;
  if (element.use < 0)
    reading.faults.add(element.where, "element " + std::to_string(element.label) +
                                          " has no section: it is in no set of a " + needs[element.nodes]);
  else if (reading.uses[element.use].kind != kind)
    reading.faults.add(element.where, "element " + std::to_string(element.label) + " needs a " + needs[element.nodes] +
                                          ", set " + in_quotes(reading.uses[element.use].set) + " has another section");
}

// The element sets of each use, members included; names that are no sets become faults.
std::vector<std::vector<int>> sets_of_uses(InpReading& reading) {
  std::vector<std::vector<int>> sets;
  for (std::size_t i = 0; i < reading.uses.size(); ++i) {
    const auto& use = reading.uses[i];
    const int set = reading.element_sets.find(use.set);
    if (set < 0)
      reading.faults.add(use.where, "there is no element set " + in_quotes(use.set) +
                                        suggestion(use.set, reading.element_sets.names()));
    for (std::size_t j = 0; j < i; ++j)
      if (upper(reading.uses[j].set) == upper(use.set))
        reading.faults.add(use.where, "element set " + in_quotes(use.set) + " has a section already");
    sets.push_back(set < 0 ? std::vector<int>{} : reading.element_sets.with_members(set));
  }
  return sets;
}

}  // namespace

std::vector<double> assign_sections(MPI_Comm comm, InpReading& reading) {
  const auto sets = sets_of_uses(reading);
  for (auto& element : reading.elements)
    for (std::size_t use = 0; use < sets.size(); ++use)
      for (const int number : sets[use]) {
        const auto& ranges = reading.element_sets.sets[number].ranges;
        if (number == element.set ||
            std::any_of(ranges.begin(), ranges.end(), [&](const auto& range) { return range.holds(element.label); }))
          assign(element, static_cast<int>(use), reading);
      }
  for (const auto& [element, use] : listed_elements(comm, sets, reading))
    assign(reading.elements[element], use, reading);

  auto& mesh = reading.mesh;
  std::vector<int> part_of(reading.uses.size(), -1);
  for (std::size_t use = 0; use < reading.uses.size(); ++use) {
    if (reading.uses[use].kind == InpUse::mass) continue;
    part_of[use] = static_cast<int>(mesh.parts.size());
    mesh.parts.push_back(reading.uses[use].set);
  }
  std::vector<double> masses;
  for (const auto& element : reading.elements) {
    refuse_wrong_use(element, reading);
    if (element.use < 0) continue;
    if (element.nodes == 1) {
      mesh.mentions.push_back({element.node_labels[0], element.where});
      mesh.masses.push_back({element.label, element.where});
      masses.push_back(reading.uses[element.use].amount);
    } else {
      mesh.cells.push_back({element.label, static_cast<CellKind>(element.nodes - 2), part_of[element.use],
                            element.node_labels, element.where});
    }
  }
  return masses;
}

}  // namespace floe::mesh
