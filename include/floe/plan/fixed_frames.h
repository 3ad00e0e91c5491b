#pragma once
#include "floe/plan/prepare.h"

namespace floe::plan {

/// The joint by which the ground clamps the body in its clamped frame, so that it stands still; -1: the frame moves.
int clamp_of(const Plan& plan, int body);

/// Whether the body's frame is fixed to the ground: by clamp_of, or because joints to the ground that neither move nor
/// are switched hold the dofs of its conditions (fixed_rims, fix_frames). Not where a probe measures one of these
/// joints, which then have constraint equations.
bool has_fixed_frame(const Plan& plan, int body);

}  // namespace floe::plan
