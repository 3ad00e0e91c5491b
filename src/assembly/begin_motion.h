#pragma once
#include "floe/assembly/model.h"

namespace floe::assembly {

/// Takes U, V of the model, which the bodies' initial states give, to the start of the motion: to the static
/// equilibrium under what acts at t = 0 if the scene wants that, at rest; then the velocities to those that joints and
/// drives allow.
/// @throws RunError  there is no equilibrium, or none is found. Collective.
void begin_motion(const Scene& scene, Model& model);

}  // namespace floe::assembly
