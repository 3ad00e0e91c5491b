#pragma once
#include <map>

#include "gmsh_cursor.h"

namespace floe::mesh {

/// A curve, surface, ... or a group of them: dimension and number.
struct GmshEntity {
  int dimension = 0;
  long long tag = 0;
  auto operator<=>(const GmshEntity&) const = default;
};

struct GmshNodeBlock {
  GmshCursor labels, positions;  // where its first label and its first position stand
  long long first, count;        // of the nodes of the file
  int reals;                     // of a node: 3, and its parameters
};

struct GmshElementBlock {
  GmshEntity entity;
  long long type, count;
  GmshCursor begin;
};

/// What a Gmsh file holds and where, without the nodes and elements themselves.
struct GmshStructure {
  std::map<GmshEntity, std::vector<long long>> groups_of;  // of an entity: tags of the groups of its dimension
  std::map<GmshEntity, std::string> group_names;
  std::vector<GmshNodeBlock> nodes;
  std::vector<GmshElementBlock> elements;
  long long node_count = 0;
};

/// Walks the file once. Rank-local.
/// @throws InputError  with the place of the first thing that is not of the format
GmshStructure gmsh_structure(const MappedFile& file);

struct GmshType {
  const char* name;
  int nodes;
};

/// Name and number of nodes of an element type; nullptr where the format has no such number.
const GmshType* gmsh_type(long long type);

}  // namespace floe::mesh
