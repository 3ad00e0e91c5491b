#pragma once
#include "build_prepare.h"

namespace floe::scene {

/// Whether two places of one body have a node in common.
bool share_a_node(const PreparedPlace& one, const PreparedPlace& other);

/// Dofs that joints hold, and those of the interface (Craig-Bampton): what the body's modes and static columns hold.
fem::Conditions held_by_modes(const PreparedBody& body);

/// Each interface moves as one rigid piece of its own: @throws InputError  it shares a node with another one, or, in
/// space, where what joints hold stands still, with a joint that holds it.
void check_interface(const Prepared& prepared, int index);

}  // namespace floe::scene
