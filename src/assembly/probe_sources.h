#pragma once
#include "floe/assembly/model.h"

namespace floe::assembly {

/// Whether a probe is of a place or of a joint, which has one; formulas and bodies have none.
inline bool has_place(const Probe& probe) { return probe.quantity != Probe::Quantity::formula && !probe.of_body(); }

/// The terms of a body, of all parts of one in several frames; none for an empty name.
std::vector<const dynamics::Term*> terms_of_body(const std::vector<std::vector<const dynamics::Term*>>& of_bodies,
                                                 const Plan& plan, const std::string& name);

/// On what a joint's drive acts: of both of a cylindrical joint the rotation, of a spring its length, or the rotation
/// where it resists this alone.
/// @throws InputError  a drive of a joint without such a coordinate
DrivenCoordinate driven_coordinate(const Plan& plan, std::size_t joint, const Probe& probe);

}  // namespace floe::assembly
