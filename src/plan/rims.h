#pragma once
#include <map>

#include "floe/plan/prepare_spatial.h"

namespace floe::plan {

/// What joints other than clamps hold of a body through one node that moves all their places (a rim of hinge lines, a
/// rigid piece).
struct Rim {
  std::string holder;       ///< a body, or `ground`
  std::vector<int> joints;  ///< of the scene
};

/// Nodes that joints of one holder, which no event switches, fix to it in all six directions together, though none of
/// them does so alone: hinges along edges that meet at an angle.
///
/// The rank of their constraints on the rigid motion of that node, J = [1 -[arm]; 0 1] in the directions that each
/// joint holds, is six.
///
/// @param places  of the body, by name; @param mesh  axes of the structure in those of the mesh
/// @return        by global node. Collective.
std::map<PetscInt, Rim> fixed_rims(const Scene& scene, const Body& body, const fem::Structure& structure,
                                   const mesh::NodeSets& places, const MeshAxes& mesh = {});

}  // namespace floe::plan
