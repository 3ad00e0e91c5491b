#include "gmsh_records.h"

#include <algorithm>
#include <optional>

#include "text.h"

namespace floe::mesh {
namespace {

constexpr int most_gmsh_nodes = 125;

std::string_view next_record(GmshCursor& cursor, Where& where) {
  where = cursor.where(cursor.at);
  return cursor.rest_of_line();
}

// `count` labels of one record; nothing where the line holds something else.
bool read_labels(GmshCursor& cursor, int count, const char* what, long long* labels, Where& where, Faults& faults) {
  if (cursor.binary) {
    where = cursor.where(cursor.at);
    for (int i = 0; i < count; ++i, cursor.at += cursor.label_width)
      labels[i] = cursor.count_at(cursor.at, cursor.label_width);
    return true;
  }
  auto line = next_record(cursor, where);
  const auto whole = line;
  for (int i = 0; i < count; ++i) {
    const auto read = number<long long>(next_word(line));
    if (!read) {
      faults.add(where, std::string("expected ") + what + ", found " + in_quotes(whole));
      return false;
    }
    labels[i] = *read;
  }
  if (next_word(line).empty()) return true;
  faults.add(where, std::string("expected ") + what + " and no more, found " + in_quotes(whole));
  return false;
}

// The position of a record, of which a label may stand before it.
std::optional<Eigen::Vector3d> read_position(GmshCursor& cursor, int reals, Faults& faults,
                                             long long* label = nullptr) {
  Eigen::Vector3d position;
  if (label && cursor.binary) {
    *label = cursor.count_at(cursor.at, cursor.label_width);
    cursor.at += cursor.label_width;
  }
  if (cursor.binary) {
    for (int i = 0; i < 3; ++i) position[i] = cursor.value<double>(cursor.at + static_cast<std::ptrdiff_t>(8) * i);
    cursor.at += static_cast<std::ptrdiff_t>(8) * reals;
    return position;
  }
  Where where;
  auto line = next_record(cursor, where);
  const auto whole = line;
  if (label) {
    const auto read = number<long long>(next_word(line));
    if (!read) {
      faults.add(where, "expected a node number and coordinates, found " + in_quotes(whole));
      return std::nullopt;
    }
    *label = *read;
  }
  for (int i = 0; i < reals; ++i) {
    const auto read = number<double>(next_word(line));
    if (!read) {
      faults.add(where, "expected " + std::to_string(reals) + " coordinates of a node, found " + in_quotes(whole));
      return std::nullopt;
    }
    if (i < 3) position[i] = *read;
  }
  if (next_word(line).empty()) return position;
  faults.add(where,
             "expected " + std::to_string(reals) + " coordinates of a node and no more, found " + in_quotes(whole));
  return std::nullopt;
}

// Moves past `count` records of `width` bytes, or lines.
void pass(GmshCursor& cursor, long long count, long long width) {
  cursor.binary ? cursor.skip_bytes(count, width, "records") : cursor.skip_lines(count, "records");
}

// The records of a block of `count` between first and last of the whole count, which starts at `start` with this block.
struct Window {
  long long skipped, count;
};
Window window(long long start, long long count, long long first, long long last) {
  const long long begin = std::max(start, first), end = std::min(start + count, last);
  return {begin - start, std::max(0LL, end - begin)};
}

void read_block(const GmshElementBlock& block, const GmshUse& use, Window part, FileMesh& mesh, Faults& faults) {
  const auto& type = *gmsh_type(block.type);
  GmshCursor cursor = block.begin;
  pass(cursor, part.skipped,
       static_cast<long long>(cursor.label_width) * (block.before + 1 + block.skipped + type.nodes));
  const std::string what = "an element number and " + std::to_string(type.nodes) + " nodes (" + type.name + ")";
  long long record[3 + 1 + 2 + gmsh_most_tags + most_gmsh_nodes];
  std::vector<long long> used;
  for (long long i = 0; i < part.count; ++i) {
    Where where;
    if (!read_labels(cursor, block.before + 1 + block.skipped + type.nodes, what.c_str(), record, where, faults))
      continue;
    const long long* labels = record + block.before;
    const long long* nodes = labels + 1 + block.skipped;
    if (use.part >= 0) {
      FileCell cell{labels[0], type.kind, use.part, no_nodes<long long>(), where};
      std::copy_n(nodes, node_count(type.kind), cell.nodes.begin());  // of nine without the one in the middle
      mesh.cells.push_back(cell);
    }
    if (!use.places.empty()) used.insert(used.end(), nodes, nodes + type.nodes);
  }
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  for (const int place : use.places) {
    auto& target = mesh.places[place].labels;
    target.insert(target.end(), used.begin(), used.end());
  }
}

}  // namespace

void read_nodes(const GmshStructure& structure, Share share, FileMesh& mesh, Faults& faults) {
  for (const auto& block : structure.nodes) {
    const auto part = window(block.first, block.count, share.first, static_cast<long long>(share.first) + share.count);
    if (part.count == 0) continue;
    GmshCursor labels = block.labels, positions = block.positions;
    if (!block.together) pass(labels, part.skipped, labels.label_width);
    pass(positions, part.skipped, 8LL * block.reals + (block.together ? positions.label_width : 0));
    for (long long i = 0; i < part.count; ++i) {
      Where where = positions.where(positions.at);
      long long label = 0;
      const bool labelled = block.together || read_labels(labels, 1, "a node number", &label, where, faults);
      const auto position = read_position(positions, block.reals, faults, block.together ? &label : nullptr);
      if (!labelled || !position) continue;
      mesh.node_labels.push_back(label);
      mesh.positions.push_back(*position);
      mesh.node_where.push_back(where);
    }
  }
}

void read_elements(const GmshStructure& structure, const GmshSelection& selection, int rank, int ranks, FileMesh& mesh,
                   Faults& faults) {
  for (const auto& name : selection.places) mesh.places.push_back({name, {0, 1}, {}});
  long long cells = 0, start = 0;
  for (std::size_t b = 0; b < selection.uses.size(); ++b)
    if (selection.uses[b].part >= 0) cells += structure.elements[b].count;
  const Share share = share_of(static_cast<PetscInt>(cells), rank, ranks);
  for (std::size_t b = 0; b < selection.uses.size(); ++b) {
    const auto& use = selection.uses[b];
    const auto& block = structure.elements[b];
    if (use.part >= 0) {
      read_block(block, use, window(start, block.count, share.first, static_cast<long long>(share.first) + share.count),
                 mesh, faults);
      start += block.count;
    } else if (!use.places.empty()) {
      const Share own = share_of(static_cast<PetscInt>(block.count), rank, ranks);
      read_block(block, use, {own.first, own.count}, mesh, faults);
    }
  }
}

}  // namespace floe::mesh
