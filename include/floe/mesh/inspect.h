#pragma once
#include "floe/mesh/raw_mesh.h"

namespace floe::mesh {

/// Nodes that elements join, directly or through other nodes.
struct Component {
  PetscInt nodes;
  long long label;  // of its first node
};

/// What is wrong, or odd, in a mesh; the same on all ranks.
struct Inspection {
  std::vector<std::string> faults;   // a mesh with one cannot be used; the first 20
  std::vector<std::string> notices;  // what may be meant
  PetscInt component_count = 0;
  std::vector<Component> components;  // the largest, at most 10, by falling size
  PetscInt opposite_edges = 0;        // between two shells of opposite orientation
};

/// Looks for what makes a mesh useless or suspicious.
///
/// Faults: coordinates that are no numbers, a node twice in a cell, cells without length or area (area <= 1e-12 of the
/// longest edge squared), quadrilaterals that are folded (not convex), elements of the same nodes.
/// Notices: several components, neighbouring shells of opposite orientation, beams side by side. Cells and nodes are
/// named by their numbers in the file.
/// @param connections  pairs of nodes that something else than an element joins (rigid links), of this rank
/// @param side_by_side  beams between the same nodes are a notice, no fault: a deck has them for members of two parts
/// Collective.
Inspection inspect(const RawMesh& mesh, const std::vector<std::array<PetscInt, 2>>& connections = {},
                   bool side_by_side = false);

}  // namespace floe::mesh
