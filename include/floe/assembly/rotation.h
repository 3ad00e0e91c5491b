#pragma once
#include "floe/assembly/model.h"
#include "floe/solve/steady_rotation.h"

namespace floe::assembly {

/// The one driven or revolute joint to the ground, about which the scene rotates; none: it has several, or none.
const Joint* hub_of(const Scene& scene);

/// @throws InputError  a body clamped to the ground
solve::RotatingSystem rotating_system(const Scene& scene, const Model& model, const solve::RotationAxis& axis);

/// A warning of each drive that moves at t = 0 beside the rotation, of bodies against each other: in a steady rotation
/// they are at rest.
std::vector<std::string> drives_beside_rotation(const Scene& scene);

/// U, V of the model to the steady rotation about the hub, at the speed that its drive has at t = 0 or, where nothing
/// drives it, the initial angular velocity of the body there.
/// @throws InputError  no hub, no speed, or a scene that cannot rotate; RunError  no steady rotation. Collective.
void start_in_rotation(const Plan& plan, Model& model);

}  // namespace floe::assembly
