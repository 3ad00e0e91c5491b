#pragma once
#include "build_reduce.h"

namespace floe::scene {

/// The model of a scene in space whose bodies all stand on the ground: frames do not move, coordinates are elastic
/// only.
///
/// @throws InputError  a body that floats or is rigid, joints between bodies, initial motion, formulation cfr.
/// Collective.
Model held_model(const Prepared& prepared, Formulation formulation, const std::vector<ReducedBody>& reduced);

}  // namespace floe::scene
