#pragma once
#include <string>

#include "floe/scene/scene.h"

namespace floe::scene {

/// Whether an event unlocks the joint.
bool is_unlocked(const Scene& scene, const std::string& joint);
/// Whether an event locks or unlocks it.
bool is_switched(const Scene& scene, const std::string& joint);

/// Whether a probe records what the joint exerts: then it keeps constraint equations of its own, whose multipliers
/// tell.
bool is_measured(const Scene& scene, const std::string& joint);

}  // namespace floe::scene
