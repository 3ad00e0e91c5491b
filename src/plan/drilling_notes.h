#pragma once
#include "floe/plan/prepare.h"

namespace floe::plan {

/// Notes on joints that hold or resist, and moments that act about, the normal of flat shells at one node that no beam,
/// spring or rigid link shares: drilling rotations of nodes follow the shells by a small stiffness only, and in the
/// theory of membranes a moment at a point has no finite rotation, so that the result depends on the mesh. Nothing
/// where another joint connects the same two bodies, which resists their rotation by forces. Collective.
void note_drilling(Plan& plan);

}  // namespace floe::plan
