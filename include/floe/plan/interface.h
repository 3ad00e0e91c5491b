#pragma once
#include "floe/plan/prepare.h"

namespace floe::plan {

/// Whether two places of one body have a node in common.
bool share_a_node(const Anchor& one, const Anchor& other);

/// Dofs that joints hold (to the ground, and where the frame is clamped: held_at_frame), and those of the interface
/// (Craig-Bampton): what the body's modes and attachment modes hold. Collective.
fem::Conditions constrained_by_modes(const Plan& plan, int index);

/// Each interface moves as one rigid region of its own: @throws InputError  it shares a node with another one, or, in
/// space, where what joints hold stands still, with a joint that holds it.
void check_interface(const Plan& plan, int index);

}  // namespace floe::plan
