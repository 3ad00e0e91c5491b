#include "refined.h"

#include "floe/assess/budget.h"

namespace floe::app {

void shorten_steps(scene::Motion& motion, int n) {
  motion.step /= n;
  if (motion.tolerance) *motion.tolerance /= n * n * n;
}

scene::Scene refined(const scene::Scene& scene) {
  scene::Scene fine = scene;
  assess::scale_meshes(fine, 2);
  shorten_steps(fine.motion, 2);
  if (!fine.motion.output) fine.motion.every *= 2;
  return fine;
}

scene::Scene at_equal_times(const scene::Scene& scene) {
  scene::Scene other = scene;
  other.motion.output = scene.motion.output.value_or(scene.motion.step * scene.motion.every);
  other.motion.every = 1;
  return other;
}

}  // namespace floe::app
