#pragma once
#include "floe/fem/reference_frame.h"

namespace floe::fem {

/// A clamped frame by dofs that the ground holds: as many of them as there are rigid motions, those that are most
/// independent (pivots of their rows of the rigid motions), displacements before rotations. What the ground holds is at
/// rest in it, so that it is fixed to the ground.
/// @param dofs  of several nodes, global, the same on all ranks
/// @throws InputError  they leave a rigid motion free. Collective.
ReferenceFrame constrained_frame(const Structure& structure, const Conditions& dofs);

/// Whether every rigid motion moves one of the dofs. Collective.
bool determine_rigid_motions(const Structure& structure, const Conditions& dofs);

}  // namespace floe::fem
