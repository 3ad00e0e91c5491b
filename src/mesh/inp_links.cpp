#include <set>

#include "inp_reading.h"
#include "text.h"

namespace floe::mesh {

void read_mass(const InpBlock& block, InpReading& reading) {
  const std::string set = reading.scopes.own(required(block, "ELSET", reading), InpName::elements);
  const auto lines = data_lines(block, 1, 1, "a mass", reading.faults);
  if (const auto type = block.parameters.find("TYPE");
      type != block.parameters.end() && upper(type->second) != "ISOTROPIC")
    reading.faults.add(block.where, "*MASS is read with TYPE=ISOTROPIC, not " + in_quotes(type->second));
  if (set.empty() || lines.empty()) return;
  const auto mass = numbers(lines[0].second, lines[0].first, 1, 1, "a mass", reading.faults);
  if (!mass) return;
  constexpr double greatest = 1e100;  // its square is a number, too
  if (!(mass->front() > 0 && mass->front() <= greatest))
    reading.faults.add(lines[0].first, "a mass must be greater than 0 and at most 1e100");
  reading.uses.push_back({InpUse::mass, set, block.where, mass->front()});
}

void read_nodal_thickness(const InpBlock& block, InpReading& reading) {
  std::vector<std::string_view> fields;
  block.each_line([&](Where where, std::string_view line) {
    split_fields(line, fields);
    const auto value = fields.size() > 1 ? fortran_number(fields[1]) : std::nullopt;
    if (!value || !(*value > 0) || fields[0].empty())
      return reading.faults.add(where, "expected a node or node set and a thickness, found " + in_quotes(line));
    reading.thicknesses.push_back({where, reading.scopes.whole(std::string(fields[0])), *value});
  });
}

void read_rigid_body(const InpBlock& block, InpReading& reading) {
  if (block.parameters.contains("ANALYTICALSURFACE"))
    return reading.faults.add(block.where,
                              "*RIGID BODY is read with NSET=, TIE NSET=, PIN NSET= or ELSET=, not with "
                              "ANALYTICALSURFACE");
  const std::string reference = required(block, "REFNODE", reading);
  const bool elements = block.parameters.contains("ELSET"), tie = block.parameters.contains("TIENSET"),
             pin = block.parameters.contains("PINNSET");
  const auto add = [&](const std::string& nodes, bool rotations = false) {
    if (reference.empty() || nodes.empty()) return;
    reading.links.push_back(
        {InpLink::rigid, block.where, reading.scopes.whole(reference), reading.scopes.whole(nodes)});
    reading.links.back().free.others = rotations;
    reading.links.back().set_first = true;
  };
  if (tie) add(required(block, "TIENSET", reading));
  if (pin) add(required(block, "PINNSET", reading), true);
  if (block.parameters.contains("NSET") || !(tie || pin || elements)) add(required(block, "NSET", reading));
  if (elements) {
    const std::string set = reading.scopes.own(required(block, "ELSET", reading), InpName::elements);
    reading.surfaces.push_back({"elements of " + set, block.where, {{block.where, set, ""}}});
    add(reading.surfaces.back().name);
  }
  if (block.parameters.contains("ROTNODE"))
    reading.notices.push_back(reading.faults.text_of(block.where) +
                              ": ROT NODE is ignored: the reference node has rotations of its own");
}

void read_mpc(const InpBlock& block, InpReading& reading) {
  std::vector<std::string_view> fields;
  block.each_line([&](Where where, std::string_view line) {
    split_fields(line, fields);
    const std::string kind = fields.empty() ? "" : upper(fields[0]);
    if (fields.size() != 3 || (kind != "BEAM" && kind != "TIE" && kind != "PIN"))
      return reading.faults.add(
          where, "*MPC expects BEAM, TIE or PIN, node (or set), reference node; found " + in_quotes(line));
    reading.links.push_back({kind == "BEAM" ? InpLink::rigid : InpLink::equal, where,
                             reading.scopes.whole(std::string(fields[2])),
                             reading.scopes.whole(std::string(fields[1]))});
    reading.links.back().free.others = kind == "PIN";
    reading.links.back().set_first = true;
  });
}

void read_coupling(const InpBlock& block, InpReading& reading) {
  const std::string reference = required(block, "REFNODE", reading), nodes = required(block, "SURFACE", reading);
  reading.coupling = InpLink{InpLink::rigid, block.where, reading.scopes.whole(reference), reading.scopes.whole(nodes)};
}

void read_kinematic(const InpBlock& block, InpReading& reading) {
  if (!reading.coupling) return reading.faults.add(block.where, "*KINEMATIC is given without a *COUPLING before it");
  InpLink link = *std::exchange(reading.coupling, std::nullopt);
  std::set<int> directions;
  const bool all = block.lines() == 0;
  block.each_line([&](Where where, std::string_view line) {
    const auto range = numbers(line, where, 1, 2, "first[, last] direction", reading.faults);
    if (!range) return;
    for (int i = 1; i <= 6; ++i)
      if (i >= range->front() && i <= range->back()) directions.insert(i);
  });
  std::vector<int> free;  // rotations
  for (int i = 4; i <= 6 && !all; ++i)
    if (!directions.contains(i)) free.push_back(i);
  if (!all && directions.size() + free.size() != 6)
    reading.faults.add(block.where, "*KINEMATIC is read with directions 1, 2, 3 and any of 4, 5, 6");
  link.free.others = free.size() > 1;
  constexpr int sum = 4 + 5 + 6;
  if (free.size() == 1) link.free.axis[static_cast<std::size_t>(free[0]) - 4] = 1;
  if (free.size() == 2) link.free.axis[static_cast<std::size_t>(sum - free[0] - free[1]) - 4] = 1;
  if (!link.reference.empty() && !link.nodes.empty()) reading.links.push_back(link);
}

void read_distributing(const InpBlock& block, InpReading& reading) {
  if (!reading.coupling) return reading.faults.add(block.where, "*DISTRIBUTING is given without a *COUPLING before it");
  InpLink link = *std::exchange(reading.coupling, std::nullopt);
  link.kind = InpLink::mean;
  if (!link.reference.empty() && !link.nodes.empty()) reading.links.push_back(link);
}

void read_tie(const InpBlock& block, InpReading& reading) {
  for (const auto& [key, value] : block.parameters)
    if (key != "NAME" && key != "POSITIONTOLERANCE" && key != "ADJUST" && key != "TYPE" && key != "NOROTATION")
      return ignore(block, "the nodes are not tied by it", reading);
  const bool free = block.parameters.contains("NOROTATION");
  std::vector<std::string_view> fields;
  block.each_line([&](Where where, std::string_view line) {
    split_fields(line, fields);
    if (fields.size() < 2) return reading.faults.add(where, "*TIE expects two surfaces, found " + in_quotes(line));
    reading.ties.push_back(
        {where, reading.scopes.whole(std::string(fields[0])), reading.scopes.whole(std::string(fields[1])), free});
  });
}

}  // namespace floe::mesh
