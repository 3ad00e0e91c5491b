#pragma once
#include "floe/scene/scene.h"

namespace floe::app {

/// Steps 1/n as long; adaptive ones by a tolerance n^3 as small, which is the power of h in the error of one.
void shorten_steps(scene::Motion& motion, int n);
/// The scene with meshes and step halved, which shows a reference's own error.
scene::Scene refined(const scene::Scene& scene);
/// The scene stored at equal times of its own whatever its steps (motion.output), so that runs of it can be compared:
/// adaptive steps, and those that end at a stop, differ between models.
scene::Scene at_equal_times(const scene::Scene& scene);

}  // namespace floe::app
