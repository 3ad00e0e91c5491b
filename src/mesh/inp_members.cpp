#include <algorithm>

#include "floe/mesh/exchange.h"
#include "floe/mesh/labels.h"
#include "inp_reading.h"
#include "text.h"

namespace floe::mesh {
namespace {

/// By GENERATE, or by *ELEMENT, ELSET=.
bool holds(const InpSet& set, int number, const InpElement& element) {
  return number == element.set || std::any_of(set.ranges.begin(), set.ranges.end(),
                                              [&](const auto& range) { return range.holds(element.label); });
}

/// Elements that are given by number, sent to the ranks that have them. Collective.
std::vector<InpMember> listed_elements(MPI_Comm comm, const std::vector<InpElementList>& lists, InpReading& reading) {
  std::vector<long long> labels, asked;
  for (const auto& element : reading.elements) labels.push_back(element.label);
  std::vector<std::pair<int, int>> origins;  // list; set or -1
  for (std::size_t i = 0; i < lists.size(); ++i) {
    const auto ask = [&](const std::vector<long long>& more, int set) {
      asked.insert(asked.end(), more.begin(), more.end());
      origins.resize(asked.size(), {static_cast<int>(i), set});
    };
    ask(lists[i].labels, -1);
    for (const int set : lists[i].sets) ask(reading.element_sets.sets[set].labels, set);
  }
  const LabelDirectory directory(comm, labels);
  const auto found = directory.find(asked);
  std::vector<InpMember> members;
  for (std::size_t i = 0; i < asked.size(); ++i) {
    const auto [list, set] = origins[i];
    if (found[i] >= 0) {
      members.push_back({found[i], list});
      continue;
    }
    const InpSet* named = set < 0 ? nullptr : &reading.element_sets.sets[set];
    reading.faults.add(named ? named->where : lists[list].where,
                       (named ? "element set " + named->name : lists[list].name) + " names element " +
                           std::to_string(asked[i]) + ", which is not defined");
  }
  const auto starts = starts_of(comm, static_cast<PetscInt>(labels.size()));
  auto received = scatter(comm, members, [&](const InpMember& m) { return owner_of(starts, m.element); }).values;
  for (auto& member : received) member.element -= directory.first();
  return received;
}

}  // namespace

std::vector<InpMember> members_of(MPI_Comm comm, const std::vector<InpElementList>& lists, InpReading& reading) {
  std::vector<InpMember> members;
  for (std::size_t e = 0; e < reading.elements.size(); ++e)
    for (std::size_t i = 0; i < lists.size(); ++i)
      for (const int number : lists[i].sets)
        if (holds(reading.element_sets.sets[number], number, reading.elements[e]))
          members.push_back({static_cast<PetscInt>(e), static_cast<int>(i)});
  const auto listed = listed_elements(comm, lists, reading);
  members.insert(members.end(), listed.begin(), listed.end());
  return members;
}

}  // namespace floe::mesh
