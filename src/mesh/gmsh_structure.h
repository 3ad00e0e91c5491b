#pragma once
#include <map>

#include "floe/mesh/raw_mesh.h"
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
  bool together = false;         // each position follows its label
};

struct GmshElementBlock {
  GmshEntity entity;
  long long type, count;
  GmshCursor begin;
  int skipped = 0;  // integers between an element's number and its nodes
  int before = 0;   // integers of a record before the element's number
};

/// What a Gmsh file holds and where, without the nodes and elements themselves.
struct GmshStructure {
  std::map<GmshEntity, std::vector<long long>> groups_of;  // of an entity: tags of the groups of its dimension
  std::map<GmshEntity, std::string> group_names;
  std::vector<GmshNodeBlock> nodes;
  std::vector<GmshElementBlock> elements;
  long long node_count = 0;
  enum Format { format_2, format_4_0, format_4_1 } format = format_4_1;
};

/// Walks the file once. Rank-local.
/// @throws InputError  with the place of the first thing that is not of the format
GmshStructure gmsh_structure(const MappedFile& file);

struct GmshType {
  const char* name;
  int nodes;
  CellKind kind = CellKind::point;  // of lines and shells that are read
};

constexpr int gmsh_most_tags = 100;        // of an element of format 2
constexpr long long gmsh_nine_nodes = 10;  // type of quadrilaterals

/// Name and number of nodes of an element type; nullptr where the format has no such number.
const GmshType* gmsh_type(long long type);

/// Dimension of the elements of a type. Throws nothing; 3 for all that is neither point, curve nor surface.
int gmsh_dimension(long long type);

}  // namespace floe::mesh
