#include <algorithm>
#include <cmath>

#include "inp_reading.h"
#include "text.h"

namespace floe::mesh {
namespace {

const std::map<std::string, CellKind>& element_kinds() {
  using enum CellKind;
  static const std::map<std::string, CellKind> kinds{
      {"B31", line},          {"B32", line3},      {"B32R", line3},        {"B33", line},
      {"S3", triangle},       {"S3R", triangle},   {"STRI3", triangle},    {"S4", quadrilateral},
      {"S4R", quadrilateral}, {"S6", triangle6},   {"S8", quadrilateral8}, {"S8R", quadrilateral8},
      {"MASS", point},        {"SPRINGA", spring}, {"SPRING2", spring}};
  return kinds;
}

// Types that differ from one that is read in integration or formulation only.
const std::map<std::string, std::string>& twins() {
  static const std::map<std::string, std::string> all{
      {"B31H", "B31"}, {"B31R", "B31"}, {"B33H", "B33"},  {"S4R5", "S4"},  {"S4RS", "S4"}, {"S4RSW", "S4"},
      {"S3RS", "S3"},  {"B32H", "B32"}, {"STRI65", "S6"}, {"S8R5", "S8R"}, {"B21", "B31"}, {"B21H", "B31"},
      {"B22", "B32"},  {"B22H", "B32"}, {"B23", "B33"},   {"B23H", "B33"}};
  return all;
}

struct ElementType {
  int nodes = 0;       // of a record; 0: the type is unknown
  bool other = false;  // neither beam, shell nor mass
  CellKind kind = CellKind::point;
};

// Nodes of solids, membranes, trusses, springs, ...: mostly the number that follows the family; 0: none of them.
int nodes_of_other(const std::string& type) {
  static const std::map<std::string, int> named{{"SPRING1", 1}, {"DASHPOTA", 2}, {"DASHPOT1", 1}, {"DASHPOT2", 2},
                                                {"GAPUNI", 2},  {"DCOUP3D", 1},  {"CONN3D2", 2},  {"RB3D2", 2},
                                                {"ROTARYI", 1}, {"D", 3}};
  if (const auto found = named.find(type); found != named.end()) return found->second;
  for (const char* family : {"C3D", "F3D", "CPS", "CPE", "CAX", "M3D", "T3D", "R3D", "SC", "DC3D", "AC3D", "COH3D"}) {
    const std::string_view start(family);
    if (!type.starts_with(start)) continue;
    const std::string_view rest = std::string_view(type).substr(start.size());
    const auto digits = std::min(rest.find_first_not_of("0123456789"), rest.size());
    const auto nodes = number<int>(rest.substr(0, digits));
    constexpr int most = 27;
    if (nodes && *nodes > 0 && *nodes <= most) return *nodes;
  }
  return 0;
}

ElementType type_of(const InpBlock& block) {
  const auto given = block.parameters.find("TYPE");
  if (given == block.parameters.end()) return {};
  std::string type = upper(given->second);
  if (const auto twin = twins().find(type); twin != twins().end()) type = twin->second;
  if (const auto found = element_kinds().find(type); found != element_kinds().end())
    return {node_count(found->second), false, found->second};
  const int nodes = nodes_of_other(type);
  return {nodes, nodes > 0, CellKind::point};
}

int nodes_of(const InpBlock& block) { return type_of(block).nodes; }

// Why elements of another type are left out without being asked; "": they are refused.
std::string reason_to_leave_out(const std::string& type) {
  if (type == "SPRING1") return "a spring to ground resists rigid motion; use springs or bushings of the scene";
  if (type.starts_with("DASHPOT")) return "damping is that of the scene";
  return "";
}

// Lines that the first record takes: it goes on after a comma at the end while nodes are missing.
long long lines_of_record(const InpBlock& block, int nodes) {
  long long lines = 0, found = 0;
  bool open = true;
  std::vector<std::string_view> fields;
  block.each_line(0, 1 + nodes, [&](Where, std::string_view line) {
    if (!open) return;
    split_fields(line, fields);
    found += static_cast<long long>(fields.size());
    ++lines;
    open = found < 1 + nodes && trimmed(line).ends_with(',');
  });
  return std::max(1LL, lines);
}

struct Window {
  long long skipped, count;
};
Window window(long long start, long long count, const Share& share) {
  const long long begin = std::max<long long>(start, share.first);
  const long long end = std::min<long long>(start + count, static_cast<long long>(share.first) + share.count);
  return {begin - start, std::max(0LL, end - begin)};
}

// An element of another kind: its label, so that sets may name it.
bool add_other(const std::vector<std::string_view>& fields, InpElement element, InpReading& reading) {
  const auto label = fields.empty() ? std::nullopt : number<long long>(fields[0]);
  if (!label) return false;
  element.label = *label;
  element.nodes = 0;
  reading.elements.push_back(element);
  return true;
}

bool add_element(const std::vector<std::string_view>& fields, InpElement element, InpReading& reading) {
  if (static_cast<int>(fields.size()) != 1 + element.nodes) return false;
  for (int i = 0; i <= element.nodes; ++i) {
    const auto label = number<long long>(fields[i]);
    if (!label) return false;
    (i ? element.node_labels[i - 1] : element.label) = *label;
  }
  if (element.kind == CellKind::line3) std::swap(element.node_labels[1], element.node_labels[2]);  // ends first
  reading.elements.push_back(element);
  return true;
}

}  // namespace

InpShares shares_of(const std::vector<InpBlock>& blocks, int rank, int ranks, Faults& faults) {
  constexpr long long most = std::numeric_limits<PetscInt>::max();
  long long nodes = 0, elements = 0;
  bool in_step = false;
  for (const auto& block : blocks) {
    in_step = block.keyword == "STEP" || (in_step && block.keyword != "ENDSTEP");
    if (in_step) continue;
    if (block.keyword == "NODE") nodes += block.lines();
    if (block.keyword == "ELEMENT" && nodes_of(block))
      elements += block.lines() / lines_of_record(block, nodes_of(block));
  }
  if (nodes > most || elements > most) {
    faults.add({0, 1}, "more than " + std::to_string(most) + " nodes or elements");
    nodes = elements = 0;
  }
  InpShares shares;
  shares.nodes = share_of(static_cast<PetscInt>(nodes), rank, ranks);
  shares.elements = share_of(static_cast<PetscInt>(elements), rank, ranks);
  return shares;
}

void read_inp_nodes(const InpBlock& block, InpShares& shares, InpReading& reading) {
  const auto named = block.parameters.find("NSET");
  const int set = named == block.parameters.end()
                      ? -1
                      : reading.node_sets.named(reading.scopes.own(named->second, InpName::nodes), block.where);
  const auto system = block.parameters.find("SYSTEM");
  const std::string axes = system == block.parameters.end() ? "R" : upper(system->second);
  if (axes != "R" && axes != "C")
    reading.faults.add(block.where, block.name + " is read with SYSTEM=R or C, not " + in_quotes(system->second));
  const Window part = window(shares.nodes_before, block.lines(), shares.nodes);
  shares.nodes_before += block.lines();
  constexpr std::size_t most_of_node = 7;  // the normal's direction may follow
  std::vector<std::string_view> fields;
  block.each_line(part.skipped, part.count, [&](Where where, std::string_view line) {
    split_fields(line, fields);
    const auto found = fields.empty() ? std::nullopt : number<long long>(fields[0]);
    const long long label = found.value_or(0);
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    bool good = found && fields.size() <= most_of_node;  // coordinates that are missing or empty are 0
    for (std::size_t i = 1; good && i < std::min<std::size_t>(fields.size(), 4); ++i) {
      const auto value = fields[i].empty() ? std::optional(0.0) : fortran_number(fields[i]);
      good = value.has_value();
      position[static_cast<Eigen::Index>(i) - 1] = value.value_or(0);
    }
    if (!good) return reading.faults.add(where, "expected a node number and its coordinates, found " + in_quotes(line));
    if (axes == "C") {  // radius, degrees, height
      const double angle = position[1] * M_PI / 180;
      position.head<2>() = position[0] * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    }
    reading.mesh.node_labels.push_back(label);
    reading.mesh.positions.push_back(position);
    reading.mesh.node_where.push_back(where);
    if (set >= 0) reading.node_sets.sets[set].labels.push_back(label);
  });
}

void read_inp_elements(const InpBlock& block, InpShares& shares, InpReading& reading) {
  const std::string type = required(block, "TYPE", reading);
  auto [nodes, other, kind] = type_of(block);
  const auto& ignored = reading.request.ignore;
  const bool asked = std::any_of(ignored.begin(), ignored.end(),
                                 [&](const std::string& name) { return !type.empty() && upper(name) == upper(type); });
  if (asked && kind == CellKind::spring) other = true;
  const std::string why = asked ? "" : reason_to_leave_out(upper(type));
  const bool left_out = asked || !why.empty();
  if ((!nodes || (other && !left_out)) && !type.empty()) {
    std::vector<std::string> known;
    for (const auto& [name, unused] : element_kinds()) known.push_back(name);
    reading.faults.add(block.where, "elements of type " + in_quotes(type) + " are not read (" + listed(known) +
                                        " are)" + (other ? "; to leave them out: file: {ignore: [" + type + "]}" : ""));
  }
  if (const auto twin = twins().find(upper(type)); twin != twins().end())
    reading.notices.push_back(
        reading.faults.text_of(block.where) + ": elements of type " + type + " are read as " + twin->second +
        (upper(type).starts_with("B2") ? ": beams in space, which the scene may hold in their plane" : ""));
  const auto named = block.parameters.find("ELSET");
  const int set = named == block.parameters.end()
                      ? -1
                      : reading.element_sets.named(reading.scopes.own(named->second, InpName::elements), block.where);
  if (!nodes) return;
  const long long lines = lines_of_record(block, nodes), records = block.lines() / lines;
  if (other && left_out)
    reading.notices.push_back(reading.faults.text_of(block.where) + ": " + counted(records, "element") + " of type " +
                              type + (records == 1 ? " is" : " are") + " left out" +
                              (why.empty() ? ", as the scene asks" : ": " + why));
  const std::string what = "an element number and " + std::to_string(nodes) + " nodes" +
                           (lines > 1 ? " on " + std::to_string(lines) + " lines, as in the first record" : "");
  if (records * lines != block.lines()) reading.faults.add(block.where, block.name + " expects records of " + what);
  const Window part = window(shares.elements_before, records, shares.elements);
  shares.elements_before += records;
  std::vector<std::string_view> fields, more;
  InpElement element{0, nodes, set, -1, no_nodes<long long>(), {}};
  element.kind = kind;
  element.axial = upper(type) == "SPRINGA";
  long long line_of_record = 0;
  block.each_line(part.skipped * lines, part.count * lines, [&](Where where, std::string_view line) {
    if (line_of_record == 0) element.where = where;
    split_fields(line, line_of_record ? more : fields);
    if (line_of_record) fields.insert(fields.end(), more.begin(), more.end());
    if (++line_of_record < lines) return;
    line_of_record = 0;
    if (!(other ? add_other(fields, element, reading) : add_element(fields, element, reading)))
      reading.faults.add(element.where, "expected " + what + ", found " + in_quotes(line));
  });
}

}  // namespace floe::mesh
