#include "gmsh_parts.h"

#include <algorithm>

#include "text.h"

namespace floe::mesh {
namespace {

std::string name_of(const GmshStructure& structure, GmshEntity group) {
  const auto found = structure.group_names.find(group);
  return found == structure.group_names.end() ? std::to_string(group.tag) : found->second;
}

// The groups that have elements, by dimension and number.
std::map<GmshEntity, std::vector<std::size_t>> blocks_of_groups(const GmshStructure& structure) {
  std::map<GmshEntity, std::vector<std::size_t>> blocks;
  for (std::size_t b = 0; b < structure.elements.size(); ++b) {
    const auto& block = structure.elements[b];
    const auto groups = structure.groups_of.find(block.entity);
    if (groups == structure.groups_of.end() || block.count == 0) continue;
    for (const long long tag : groups->second) blocks[{block.entity.dimension, tag}].push_back(b);
  }
  return blocks;
}

int place_of(GmshSelection& selection, const std::string& name) {
  const auto found = std::find(selection.places.begin(), selection.places.end(), name);
  if (found == selection.places.end()) selection.places.push_back(name);
  return static_cast<int>(std::find(selection.places.begin(), selection.places.end(), name) - selection.places.begin());
}

// The wanted groups in the order that they are wanted in; of two with one name the one of higher dimension.
std::vector<GmshEntity> wanted_groups(const GmshStructure& structure, const std::vector<std::string>& wanted,
                                      const std::map<GmshEntity, std::vector<std::size_t>>& blocks, Faults& faults) {
  std::vector<GmshEntity> chosen;
  std::vector<std::string> known;
  for (const auto& [group, unused] : blocks)
    if (group.dimension > 0) known.push_back(name_of(structure, group));
  for (const auto& name : wanted) {
    GmshEntity best{-1, 0};
    for (const auto& [group, unused] : blocks)
      if (name_of(structure, group) == name && group.dimension > best.dimension) best = group;
    if (best.dimension > 0)
      chosen.push_back(best);
    else
      faults.add({0, 1}, "there is no physical group " + in_quotes(name) + " with curves or surfaces" +
                             suggestion(name, known) + (known.empty() ? "" : " (the file has: " + listed(known) + ")"));
  }
  return chosen;
}

void make_part(const GmshStructure& structure, GmshSelection& selection, const std::string& name,
               const std::vector<std::size_t>& blocks, Faults& faults) {
  const int part = static_cast<int>(selection.parts.size());
  selection.parts.push_back(name);
  for (const std::size_t b : blocks) {
    const auto& block = structure.elements[b];
    const char* place = block.begin.at;
    if (selection.uses[b].part >= 0)
      faults.add(block.begin.where(place), "these elements belong to two parts, " +
                                               in_quotes(selection.parts[selection.uses[b].part]) + " and " +
                                               in_quotes(name) + ": give one of them a section");
    if (gmsh_type(block.type)->kind == CellKind::point)
      faults.add(block.begin.where(place),
                 "part " + in_quotes(name) + " has elements of type " + std::to_string(block.type) + " (" +
                     gmsh_type(block.type)->name +
                     "); lines of 2 and 3, triangles of 3 and 6, quadrilaterals of 4, 8 and 9 nodes are "
                     "read");
    if (block.type == gmsh_nine_nodes) selection.without_middle += block.count;
    selection.uses[b].part = part;
  }
}

// Of a group's elements those that belong to no part yet.
void make_part_of_rest(const GmshStructure& structure, GmshSelection& selection, const std::string& name,
                       const std::vector<std::size_t>& blocks, Faults& faults) {
  std::vector<std::size_t> rest;
  std::map<std::string, long long> shared;
  for (const std::size_t b : blocks)
    if (const int part = selection.uses[b].part; part < 0)
      rest.push_back(b);
    else if (selection.parts[part] != name)
      shared[selection.parts[part]] += structure.elements[b].count;
  for (const auto& [part, count] : shared)
    selection.shared.push_back("of group " + in_quotes(name) + " " + std::to_string(count) +
                               (count == 1 ? " element belongs to part " : " elements belong to part ") +
                               in_quotes(part) +
                               " and has its section; in the scene's `parts` name the group that is "
                               "to have them");
  if (!rest.empty()) make_part(structure, selection, name, rest, faults);
}

// Without a list of parts: all groups of the highest dimension, or all its elements.
void take_highest(const GmshStructure& structure, GmshSelection& selection,
                  const std::map<GmshEntity, std::vector<std::size_t>>& groups, Faults& faults) {
  int highest = 0;
  std::vector<std::size_t> all;
  for (const auto& block : structure.elements)
    if (block.count > 0) highest = std::max(highest, block.entity.dimension);
  for (std::size_t b = 0; b < structure.elements.size(); ++b)
    if (structure.elements[b].entity.dimension == highest && structure.elements[b].count > 0) all.push_back(b);
  if (highest == 0) return;
  for (const auto& [group, blocks] : groups)
    if (group.dimension == highest) make_part_of_rest(structure, selection, name_of(structure, group), blocks, faults);
  if (selection.parts.empty()) return make_part(structure, selection, "mesh", all, faults);
  for (const std::size_t b : all)
    if (selection.uses[b].part < 0) selection.left_out += structure.elements[b].count;
}

}  // namespace

GmshSelection select_parts(const GmshStructure& structure, const WantedParts& wanted, Faults& faults) {
  GmshSelection selection;
  selection.uses.resize(structure.elements.size());
  const auto groups = blocks_of_groups(structure);
  for (const auto& [group, blocks] : groups) {
    const int place = place_of(selection, name_of(structure, group));
    for (const std::size_t b : blocks) selection.uses[b].places.push_back(place);
  }
  for (const auto& group : wanted_groups(structure, wanted.names, groups, faults))
    make_part(structure, selection, name_of(structure, group), groups.at(group), faults);
  if (wanted.others || wanted.names.empty()) take_highest(structure, selection, groups, faults);
  if (selection.parts.empty() && !faults.any())
    faults.add({0, 1}, "the file has no lines, triangles or quadrilaterals");
  return selection;
}

}  // namespace floe::mesh
