#pragma once
#include "floe/scene/scene.h"

namespace floe::app {

/// The scene with meshes and step halved, which shows a reference's own error.
scene::Scene refined(const scene::Scene& scene);
/// The scene stored at equal times of its own whatever its steps (motion.output), so that runs of it can be compared:
/// adaptive steps, and those that end at a stop, differ between models.
scene::Scene at_equal_times(const scene::Scene& scene);

}  // namespace floe::app
