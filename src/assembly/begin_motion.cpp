#include "begin_motion.h"

#include <fmt/format.h>

#include "floe/assembly/rotation.h"
#include "floe/solve/start.h"

namespace floe::assembly {

void begin_motion(const Plan& plan, Model& model) {
  const Scene& scene = plan.scene;
  if (scene.motion.start == Motion::Start::equilibrium) {
    petsc::check(VecSet(model.V, 0));
    try {
      solve::equilibrium(*model.system, 0, model.U, model.V, true);
    } catch (const RunError& error) {
      throw RunError(fmt::format("{}.start: no static equilibrium was found at t = 0: {}", scene.motion.where.text(),
                                 error.what()));
    }
    model.system->rebase(model.U);
  }
  if (scene.motion.start == Motion::Start::steady_rotation) start_in_rotation(plan, model);
  model.velocity_correction = solve::consistent_velocities(*model.system, 0, model.U, model.V);
}

}  // namespace floe::assembly
