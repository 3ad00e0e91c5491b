#pragma once
#include "floe/plan/prepare.h"

namespace floe::plan {

/// Whether a joint between two bodies acts on the place where the frame of this body is clamped.
///
/// Nothing deforms there: a force or moment at the place has no static response in the frame. Modes of a body that is
/// free there then lack what the joint transmits (a cantilever fixed to a hub: 23 % too stiff with four of them).
bool joins_at_frame(const Plan& plan, int body, std::size_t joint);

/// Dofs of the body that such joints hold there. Collective.
fem::Conditions held_at_frame(const Plan& plan, int body);

}  // namespace floe::plan
