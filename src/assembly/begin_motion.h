#pragma once
#include "floe/assembly/model.h"

namespace floe::assembly {

/// Takes U, V of the model, which the bodies' initial states give, to the start of the motion: to the static
/// equilibrium under what acts at t = 0 if the scene wants that, at rest, or to a steady rotation; then the velocities
/// to those that joints and drives allow.
/// @throws RunError  there is no equilibrium, or none is found; InputError  as start_in_rotation. Collective.
void begin_motion(const Plan& plan, Model& model);

}  // namespace floe::assembly
