#include "begin_motion.h"

#include <fmt/format.h>

#include <algorithm>

#include "floe/assembly/rotation.h"
#include "floe/solve/start.h"

namespace floe::assembly {

namespace {

/// Whether bodies are at rest, and joints and drives lead nowhere during the motion: rates at t = 0 of formulas whose
/// derivative is singular there are round-off.
bool stays_at_rest(const Scene& scene, const Model& model) {
  double size = 0;
  petsc::check(VecNorm(model.V, NORM_INFINITY, &size));
  const double rate = solve::constraint_violation(*model.system, 0, model.U, model.V, solve::ConstraintLevel::velocity);
  return size == 0 && rate * scene.motion.end <= 1e-7 * std::min(1.0, model.extent);
}

}  // namespace

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
  const bool round_off = stays_at_rest(scene, model);
  petsc::VecHandle given;
  petsc::check(VecDuplicate(model.V, given.out()));
  petsc::check(VecCopy(model.V, given));
  model.velocity_correction = solve::consistent_velocities(*model.system, 0, model.U, model.V);
  if (round_off) model.velocity_correction = 0;
  if (model.velocity_correction > 1e-10 && !scene.motion.tolerance)
    solve::damp_jump(*model.system, 0, scene.motion.step, model.U, given, model.V);
}

}  // namespace floe::assembly
