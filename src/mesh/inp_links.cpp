#include <set>

#include "inp_reading.h"
#include "text.h"

namespace floe::mesh {

void read_mass(const InpBlock& block, InpReading& reading) {
  const std::string set = without_instance(required(block, "ELSET", reading), reading);
  const auto lines = data_lines(block, 1, 1, "a mass", reading.faults);
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
    reading.thicknesses.push_back({where, std::string(fields[0]), *value});
  });
}

void read_rigid_body(const InpBlock& block, InpReading& reading) {
  for (const char* key : {"ELSET", "PINNSET", "ANALYTICALSURFACE"})
    if (block.parameters.contains(key))
      return reading.faults.add(block.where,
                                "*RIGID BODY is read with NSET= or TIE NSET=, not with " + std::string(key));
  const bool tie = block.parameters.contains("TIENSET");
  const std::string reference = required(block, "REFNODE", reading);
  const std::string nodes = required(block, tie ? "TIENSET" : "NSET", reading);
  if (!reference.empty() && !nodes.empty()) reading.links.push_back({block.where, reference, nodes});
  if (block.parameters.contains("ROTNODE"))
    reading.notices.push_back(reading.faults.text_of(block.where) +
                              ": ROT NODE is ignored: the reference node has rotations of its own");
}

void read_mpc(const InpBlock& block, InpReading& reading) {
  std::vector<std::string_view> fields;
  block.each_line([&](Where where, std::string_view line) {
    split_fields(line, fields);
    if (fields.size() != 3 || upper(fields[0]) != "BEAM")
      return reading.faults.add(where, "*MPC expects BEAM, node (or set), reference node; found " + in_quotes(line));
    reading.links.push_back({where, std::string(fields[2]), std::string(fields[1])});
  });
}

void read_coupling(const InpBlock& block, InpReading& reading) {
  const std::string reference = required(block, "REFNODE", reading), nodes = required(block, "SURFACE", reading);
  reading.coupling = InpLink{block.where, reference, nodes};
}

void read_kinematic(const InpBlock& block, InpReading& reading) {
  if (!reading.coupling) return reading.faults.add(block.where, "*KINEMATIC is given without a *COUPLING before it");
  const InpLink link = *std::exchange(reading.coupling, std::nullopt);
  std::set<int> directions;
  const bool all = block.lines() == 0;
  block.each_line([&](Where where, std::string_view line) {
    const auto range = numbers(line, where, 1, 2, "first[, last] direction", reading.faults);
    if (!range) return;
    for (int i = 1; i <= 6; ++i)
      if (i >= range->front() && i <= range->back()) directions.insert(i);
  });
  if (!all && directions.size() != 6)
    reading.faults.add(block.where, "*KINEMATIC is read with all six directions (1, 6)");
  if (!link.reference.empty() && !link.nodes.empty()) reading.links.push_back(link);
}

}  // namespace floe::mesh
