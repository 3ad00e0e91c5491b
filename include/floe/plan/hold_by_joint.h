#pragma once
#include "floe/plan/prepare.h"

namespace floe::plan {

/// Appends the dofs of a body that a joint holds at one of its places, in frame axes, as far as dofs hold what it does;
/// what the other side is does not matter. @return  whether they hold all of it. Collective.
bool hold_place_by_joint(const Plan& plan, std::size_t joint, const Anchor& place, fem::Conditions& constrained);
/// The same in space.
bool hold_spatial_place_by_joint(const Plan& plan, std::size_t joint, const Anchor& place,
                                 fem::Conditions& constrained);

}  // namespace floe::plan
