#pragma once
#include <functional>

#include "floe/plan/prepare_spatial.h"

namespace floe::plan {

/// Whether the joint holds a place in all directions, where it is or where a drive moves it.
bool clamps(const Joint& joint);

/// Diagonal of the box about the mesh. Collective.
double extent_of_mesh(const fem::Mesh& mesh);

/// Axes of all joints, and what those to the ground hold of their bodies. Collective.
void prepare_joints(Plan& plan, const std::function<Anchor(const Place&)>& place);

/// Bodies without a frame of their own that the ground holds in all directions, at places half their extent apart or
/// node by node (edges: mean): their frames are fixed to the ground, and its joints need no constraints.
///
/// A frame that moves would rotate with the mean deformation: linear bodies would not be linear, and nodal rotations,
/// which are free at edges that are constrained node by node, would be constrained in their mean. Collective.
void fix_frames(Plan& plan);

}  // namespace floe::plan
