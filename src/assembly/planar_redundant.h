#pragma once
#include "floe/assembly/reduce_bodies.h"

namespace floe::assembly {

/// How many rows a joint has as a constraint.
int joint_rows(const Joint& joint);

/// For each joint the rows of its constraint that are kept.
///
/// Modes of a body "as its joints hold it" satisfy what the joints hold, so that several joints of one body to the
/// ground repeat one another: every basis vector of a beam hinged at both ends keeps the distance of its ends, and
/// along the beam the second hinge repeats the first. A row is left out if its gradient at the start depends on those
/// before it, and if it stays satisfied wherever these are: tested at positions with these met and other coordinates
/// given. Of what remains, rows between bodies with a frame (rigid, reduced, from files) that no event switches are
/// left out likewise, with the bodies moved, too: a third parallel crank.
/// @throws InputError  a row that a function of time drives depends on others: no basis vector follows it; or
///                     the row is implied to first order only: the basis vectors leave the joints as the body deforms
///                     (the frame does not pass through them); or a redundant joint is one that an event unlocks.
///                     Collective; replicated.
/// @param undetermined  receives the joints whose multipliers the rows do not determine
/// @param notes  a line for each joint that loses rows to other bodies' joints
std::vector<std::vector<int>> independent_rows(const Plan& plan, const std::vector<ReducedBody>& reduced,
                                               const std::map<std::string, JointSwitches>& switches,
                                               std::vector<int>& undetermined, std::vector<std::string>& notes);

}  // namespace floe::assembly
