#pragma once
#include "gmsh_structure.h"

namespace floe::mesh {

/// What becomes of the elements of a block.
struct GmshUse {
  int part = -1;            // -1: no cells
  std::vector<int> places;  // that take the elements' nodes
};

struct GmshSelection {
  std::vector<std::string> parts, places;
  std::vector<GmshUse> uses;             // of each element block
  long long left_out = 0;                // elements of the parts' dimension that are in no group
  long long without_middle = 0;          // quadrilaterals of nine nodes
  std::vector<std::string> shared = {};  // groups whose elements belong to other parts, in words
};

/// As read_gmsh has them.
struct WantedParts {
  const std::vector<std::string>& names;
  bool others;
};

/// Chooses the blocks that become parts and places; see read_gmsh. Rank-local.
GmshSelection select_parts(const GmshStructure& structure, const WantedParts& wanted, Faults& faults);

}  // namespace floe::mesh
