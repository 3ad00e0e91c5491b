#include "gmsh_structure.h"

#include <algorithm>
#include <bit>
#include <cstdint>

#include "text.h"

namespace floe::mesh {
namespace {

void read_format(GmshCursor& cursor, GmshStructure& result) {
  const std::string version(cursor.word("a format version"));
  if (version == "4.1")
    result.format = GmshStructure::format_4_1;
  else if (version == "4" || version == "4.0")
    result.format = GmshStructure::format_4_0;
  else if (version == "2" || version == "2.0" || version == "2.1" || version == "2.2")
    result.format = GmshStructure::format_2;
  else
    cursor.refuse("format " + in_quotes(version) +
                  " of Gmsh is not read, only 2 to 2.2, 4.0 and 4.1: convert with  gmsh old.msh -save -format msh41 -o "
                  "new.msh");
  const long long kind = cursor.integer("0 (text) or 1 (binary)");
  if (kind != 0 && kind != 1) cursor.refuse("expected 0 (text) or 1 (binary), found " + std::to_string(kind));
  const long long width = cursor.integer("the bytes of a count, 4 or 8");
  if (width != 4 && width != 8) cursor.refuse("expected 4 or 8 bytes of a count, found " + std::to_string(width));
  const bool newest = result.format == GmshStructure::format_4_1;
  cursor.count_width = newest ? static_cast<int>(width) : 8;  // elsewhere the width is that of a real number
  cursor.label_width = newest ? static_cast<int>(width) : 4;
  if (kind == 1) {
    cursor.rest_of_line();
    if (cursor.end - cursor.at < 4) cursor.refuse("the file ends where the number 1 in binary was expected");
    const auto one = cursor.value<std::int32_t>(cursor.at);
    constexpr std::int32_t other_one = 0x01000000;
    if (one != 1 && one != other_one) cursor.refuse("expected the number 1 in binary, in either byte order");
    cursor.swapped = one == other_one;
    cursor.at += 4;
  }
  cursor.expect("$EndMeshFormat");
  cursor.binary = kind == 1;
}

void read_names(GmshCursor& cursor, GmshStructure& result) {
  const bool binary = std::exchange(cursor.binary, false);  // this section is always text
  const long long count = cursor.count("the number of physical names");
  for (long long i = 0; i < count; ++i) {
    const auto dimension = cursor.integer("the dimension of a physical group");
    if (dimension < 0 || dimension > 3) cursor.refuse("a physical group has dimension 0 to 3");
    const auto tag = cursor.integer("the number of a physical group");
    auto text = trimmed(cursor.rest_of_line());
    if (text.size() < 3 || text.front() != '"' || text.back() != '"') {
      --cursor.line;
      cursor.refuse("expected the name of a physical group in quotes, found " + in_quotes(text));
    }
    result.group_names[{static_cast<int>(dimension), tag}] = std::string(text.substr(1, text.size() - 2));
  }
  cursor.expect("$EndPhysicalNames");
  cursor.binary = binary;
}

void read_entities(GmshCursor& cursor, GmshStructure& result) {
  constexpr int dimensions = 4, corner_reals = 3, box_reals = 6;
  long long counts[dimensions];
  for (auto& count : counts) count = cursor.count("the number of entities");
  for (int dimension = 0; dimension < dimensions; ++dimension) {
    for (long long i = 0; i < counts[dimension]; ++i) {
      const auto tag = cursor.integer("the number of an entity");
      const bool boxed = dimension > 0 || result.format == GmshStructure::format_4_0;
      for (int k = 0; k < (boxed ? box_reals : corner_reals); ++k) cursor.real();
      auto& groups = result.groups_of[{dimension, tag}];
      const long long group_count = cursor.count("the number of physical groups");
      for (long long k = 0; k < group_count; ++k)
        groups.push_back(std::abs(cursor.integer("the number of a physical group")));
      const long long bounds = dimension ? cursor.count("the number of bounding entities") : 0;
      for (long long k = 0; k < bounds; ++k) cursor.integer("the number of a bounding entity");
    }
  }
  cursor.expect("$EndEntities");
}

void begin_records(GmshCursor& cursor) {
  if (!cursor.binary) cursor.rest_of_line();
}

void read_node_blocks(GmshCursor& cursor, GmshStructure& result) {
  if (!result.nodes.empty()) cursor.refuse("there is a second $Nodes section");
  const long long blocks = cursor.count("the number of node blocks");
  const long long nodes = cursor.count("the number of nodes");
  const bool together = result.format == GmshStructure::format_4_0;
  if (!together)
    for (const char* of : {"the minimum node number", "the maximum node number"}) cursor.count(of);
  for (long long i = 0; i < blocks; ++i) {
    const auto first = cursor.integer("the dimension of a node block"),
               second = cursor.integer("the entity of a node block");
    const long long dimension = together ? second : first;
    const long long parametric = cursor.integer("0 or 1 (parametric)");
    if (dimension < 0 || dimension > 3 || parametric < 0 || parametric > 1)
      cursor.refuse("expected the header of a node block: dimension, entity, parametric, number of nodes");
    const long long count = cursor.count("the number of nodes of a block");
    begin_records(cursor);
    const GmshCursor labels = cursor;
    const int reals = 3 + static_cast<int>(parametric ? dimension : 0);
    if (!together)
      cursor.binary ? cursor.skip_bytes(count, cursor.label_width, "node numbers")
                    : cursor.skip_lines(count, "lines of node numbers");
    const GmshCursor positions = cursor;
    cursor.binary ? cursor.skip_bytes(count, 8LL * reals + (together ? cursor.label_width : 0), "node positions")
                  : cursor.skip_lines(count, "lines of node positions");
    result.nodes.push_back({labels, positions, result.node_count, count, reals, together});
    result.node_count += count;
  }
  if (result.node_count != nodes)
    cursor.refuse("$Nodes announces " + std::to_string(nodes) + " nodes, its blocks have " +
                  std::to_string(result.node_count));
  cursor.expect("$EndNodes");
}

void read_element_blocks(GmshCursor& cursor, GmshStructure& result) {
  if (!result.elements.empty()) cursor.refuse("there is a second $Elements section");
  const long long blocks = cursor.count("the number of element blocks");
  const long long elements = cursor.count("the number of elements");
  const bool old = result.format == GmshStructure::format_4_0;
  if (!old)
    for (const char* of : {"the minimum element number", "the maximum element number"}) cursor.count(of);
  long long total = 0;
  for (long long i = 0; i < blocks; ++i) {
    auto dimension = cursor.integer("the dimension of an element block");
    auto tag = cursor.integer("the entity of an element block");
    if (old) std::swap(dimension, tag);
    if (dimension < 0 || dimension > 3) cursor.refuse("an element block has dimension 0 to 3");
    const long long type = cursor.integer("an element type");
    if (!gmsh_type(type)) cursor.refuse("element type " + std::to_string(type) + " is unknown");
    const long long count = cursor.count("the number of elements of a block");
    begin_records(cursor);
    result.elements.push_back({{static_cast<int>(dimension), tag}, type, count, cursor});
    cursor.binary ? cursor.skip_bytes(count, static_cast<long long>(cursor.label_width) * (1 + gmsh_type(type)->nodes),
                                      "elements")
                  : cursor.skip_lines(count, "lines of elements");
    total += count;
  }
  if (total != elements)
    cursor.refuse("$Elements announces " + std::to_string(elements) + " elements, its blocks have " +
                  std::to_string(total));
  cursor.expect("$EndElements");
}

// Of format 2, whose counts are text also in binary files.
long long plain_count(GmshCursor& cursor, const char* of) {
  const bool binary = std::exchange(cursor.binary, false);
  const long long count = cursor.count(of);
  cursor.rest_of_line();
  cursor.binary = binary;
  return count;
}

void read_plain_nodes(GmshCursor& cursor, GmshStructure& result) {
  if (!result.nodes.empty()) cursor.refuse("there is a second $Nodes section");
  const long long count = plain_count(cursor, "the number of nodes");
  const GmshCursor begin = cursor;
  constexpr int reals = 3;
  cursor.binary ? cursor.skip_bytes(count, cursor.label_width + 8LL * reals, "nodes")
                : cursor.skip_lines(count, "lines of nodes");
  result.nodes.push_back({begin, begin, 0, count, reals, true});
  result.node_count = count;
  cursor.expect("$EndNodes");
}

// An element of format 2: consecutive ones of a type and group make a block, unless something stands between them.
// @param before  integers of the record before the element's number
void add_plain_element(const GmshCursor& record, long long type, long long tags, long long group, int before,
                       bool apart, GmshStructure& result) {
  const GmshEntity entity{gmsh_dimension(type), std::abs(group)};
  const int skipped = static_cast<int>(tags) + (record.binary ? 0 : 2);
  const auto* last = result.elements.empty() ? nullptr : &result.elements.back();
  if (apart || !last || last->type != type || last->entity != entity || last->skipped != skipped ||
      last->before != before) {
    if (group != 0) result.groups_of[entity] = {entity.tag};
    result.elements.push_back({entity, type, 0, record, skipped, before});
  }
  ++result.elements.back().count;
}

void check_plain_type(const GmshCursor& cursor, long long type, long long tags) {
  if (!gmsh_type(type)) cursor.refuse("element type " + std::to_string(type) + " is unknown");
  if (tags < 0 || tags > gmsh_most_tags)
    cursor.refuse("expected 0 to " + std::to_string(gmsh_most_tags) + " tags of an element, found " +
                  std::to_string(tags));
}

void read_plain_elements(GmshCursor& cursor, GmshStructure& result) {
  if (!result.elements.empty()) cursor.refuse("there is a second $Elements section");
  const long long count = plain_count(cursor, "the number of elements");
  for (long long i = 0; i < count;) {
    const GmshCursor record = cursor;
    if (!cursor.binary) {
      if (cursor.at == cursor.end || *cursor.at == '$')
        cursor.refuse("expected " + std::to_string(count) + " lines of elements, found " + std::to_string(i));
      cursor.integer("an element number");
      const auto type = cursor.integer("an element type"), tags = cursor.integer("the number of tags");
      check_plain_type(record, type, tags);
      const long long group = tags > 0 ? cursor.integer("a physical group") : 0;
      cursor.at = record.at, cursor.line = record.line;
      cursor.rest_of_line();
      add_plain_element(record, type, tags, group, 0, false, result);
      ++i;
      continue;
    }
    const auto type = cursor.integer("an element type"), more = cursor.integer("the number of elements of a type"),
               tags = cursor.integer("the number of tags");
    check_plain_type(record, type, tags);
    if (more < 1 || more > count - i)
      cursor.refuse("expected 1 to " + std::to_string(count - i) + " elements of a type, found " +
                    std::to_string(more));
    const long long width = cursor.label_width * (1 + tags + gmsh_type(type)->nodes);
    constexpr int header = 3;
    for (long long k = 0; k < more; ++k) {
      const GmshCursor element = cursor;
      cursor.skip_bytes(1, width, "elements");
      const long long group = tags > 0 ? element.value<std::int32_t>(element.at + element.label_width) : 0;
      if (more == 1)
        add_plain_element(record, type, tags, group, header, false, result);
      else
        add_plain_element(element, type, tags, group, 0, k == 0, result);
    }
    i += more;
  }
  cursor.expect("$EndElements");
}

void skip_section(GmshCursor& cursor, const std::string& name) {
  const std::string_view text(cursor.at, static_cast<std::size_t>(cursor.end - cursor.at));
  const std::string last = "$End" + name.substr(1);
  const auto found = text.find(last);
  if (found == std::string_view::npos) cursor.refuse("section " + in_quotes(name) + " has no " + in_quotes(last));
  cursor.line += std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(found), '\n');
  cursor.at += found + last.size();
}

void read_section(GmshCursor& cursor, const std::string& name, GmshStructure& result) {
  if (name == "$PhysicalNames") return read_names(cursor, result);
  if (name == "$Entities") return read_entities(cursor, result);
  const bool plain = result.format == GmshStructure::format_2;
  if (name == "$Nodes") return plain ? read_plain_nodes(cursor, result) : read_node_blocks(cursor, result);
  if (name == "$Elements") return plain ? read_plain_elements(cursor, result) : read_element_blocks(cursor, result);
  if (name == "$PartitionedEntities")
    cursor.refuse("a partitioned mesh is not read: save the mesh that was not partitioned");
  skip_section(cursor, name);
}

}  // namespace

GmshStructure gmsh_structure(const MappedFile& file) {
  GmshCursor cursor(file);
  GmshStructure result;
  std::string name(cursor.word("'$MeshFormat'"));
  for (; name == "$Comments"; name = cursor.word("'$MeshFormat'")) skip_section(cursor, name);
  if (name != "$MeshFormat")
    cursor.refuse("expected '$MeshFormat', found " + in_quotes(name) + ": is this a Gmsh file?");
  read_format(cursor, result);
  while (!cursor.done()) {
    const char* place = cursor.at;
    name = cursor.word("a section");
    if (name.size() < 2 || name[0] != '$' || name.starts_with("$End"))
      cursor.refuse_at(place, "expected a section ($Nodes, ...), found " + in_quotes(name));
    cursor.rest_of_line();
    read_section(cursor, name, result);
  }
  for (const auto& [missing, text] : {std::pair(result.nodes.empty(), "nodes"), {result.elements.empty(), "elements"}})
    if (missing) cursor.refuse(std::string("the file ends, and it has no ") + text);
  return result;
}

}  // namespace floe::mesh
