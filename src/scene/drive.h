#pragma once
#include "floe/dynamics/time_function.h"
#include "floe/scene/scene.h"

namespace floe::scene {

/// The angle or position that a driven joint gives, with its rates; of a speed its integral from t = 0.
/// @param motion  how finely the integral is kept: by panels of 16 steps
/// @throws InputError  an angle or position that is not 0 at t = 0
dynamics::TimeFunction drive_of(const Joint& joint, const Motion& motion);

}  // namespace floe::scene
