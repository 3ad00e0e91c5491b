#include "floe/dynamics/simulation.h"

#include <fmt/format.h>

#include "floe/dynamics/generalized_alpha.h"
#include "floe/dynamics/start.h"

namespace floe::dynamics {

using petsc::check;

namespace {

struct Context {
  const System& system;
  const std::function<void(const Instant&)>& observe;
  const Integration& how;
  petsc::Guard guard;
};

PetscErrorCode residual(TS, PetscReal t, Vec U, Vec V, Vec A, Vec F, void* context) {
  auto& c = *static_cast<Context*>(context);
  return c.guard.run([&] { c.system.residual(t, U, V, A, ConstraintLevel::position, F); });
}

PetscErrorCode tangent(TS, PetscReal t, Vec U, Vec V, Vec A, PetscReal shift_v, PetscReal shift_a, Mat J, Mat,
                       void* context) {
  auto& c = *static_cast<Context*>(context);
  return c.guard.run([&] { c.system.tangent(t, U, V, A, {1, shift_v, shift_a}, J); });
}

PetscErrorCode start(TS, PetscReal t, Vec U, Vec V, Vec A, void* context) {
  auto& c = *static_cast<Context*>(context);
  return c.guard.run([&] { consistent_start(c.system, t, U, V, A); });
}

PetscErrorCode monitor(TS ts, PetscInt step, PetscReal t, Vec U, void* context) {
  auto& c = *static_cast<Context*>(context);
  return c.guard.run([&] {
    Vec V = nullptr, A = nullptr;
    check(TS2GetSolution(ts, nullptr, &V));
    check(TSGeneralizedAlphaGetAcceleration(ts, &A));
    c.observe({t, step, U, V, A, t >= c.how.end * (1 - 1e-12)});
  });
}

void set_up(TS ts, const System& system, const Integration& how, Context& context, Vec U, Vec V, Vec F, Mat J) {
  SNES snes = nullptr;
  KSP ksp = nullptr;
  TSAdapt adapt = nullptr;
  check(TSSetOptionsPrefix(ts, how.prefix.c_str()));
  check(TSSetProblemType(ts, TS_NONLINEAR));
  check(TSSetI2Function(ts, F, residual, &context));
  check(TSSetI2Jacobian(ts, J, J, tangent, &context));
  check(TS2SetSolution(ts, U, V));
  check(TSSetType(ts, generalized_alpha));
  check(TSGeneralizedAlphaSetRadius(ts, how.radius));
  const petsc::IsHandle multipliers = system.multipliers();
  check(TSGeneralizedAlphaSetMultipliers(ts, multipliers));
  check(TSGeneralizedAlphaSetStart(ts, start, &context));
  check(TSSetTimeStep(ts, how.step));
  check(TSSetMaxTime(ts, how.end));
  check(TSSetMaxSteps(ts, PETSC_MAX_INT));
  check(TSSetErrorIfStepFails(ts, PETSC_FALSE));
  check(TSSetExactFinalTime(ts, TS_EXACTFINALTIME_MATCHSTEP));
  check(TSGetAdapt(ts, &adapt));
  check(TSAdaptSetType(adapt, how.tolerance ? TSADAPTBASIC : TSADAPTNONE));
  if (how.tolerance) check(TSSetTolerances(ts, 0, nullptr, *how.tolerance, nullptr));
  check(TSMonitorSet(ts, monitor, &context, nullptr));
  check(TSGetSNES(ts, &snes));
  check(SNESSetType(snes, SNESNEWTONLS));
  SNESLineSearch search = nullptr;
  check(SNESGetLineSearch(snes, &search));
  check(SNESLineSearchSetType(search, SNESLINESEARCHBASIC));
  check(SNESGetKSP(snes, &ksp));
  set_tangent_solver(ksp, J);
  check(TSSetFromOptions(ts));
}

}  // namespace

IntegrationReport simulate(const System& system, const Integration& how, Vec U, Vec V,
                           const std::function<void(const Instant&)>& observe) {
  Context context{system, observe, how, {}};
  const petsc::VecHandle F = system.create_vector();
  const petsc::MatHandle J = system.create_tangent();
  petsc::TsHandle ts;
  check(TSCreate(system.comm(), ts.out()));
  set_up(ts, system, how, context, U, V, F, J);

  IntegrationReport report;
  TSType type = nullptr;
  check(TSGetType(ts, &type));
  report.type = type;
  const double begin = MPI_Wtime();
  const PetscErrorCode code = TSSolve(ts, U);
  report.seconds = MPI_Wtime() - begin;
  TSGetStepNumber(ts, &report.steps);
  TSGetTime(ts, &report.end);
  TSGetSNESIterations(ts, &report.newton);
  TSGetKSPIterations(ts, &report.solves);
  TSGetStepRejections(ts, &report.rejected);
  context.guard.check(code);

  TSConvergedReason reason = TS_CONVERGED_ITERATING;
  check(TSGetConvergedReason(ts, &reason));
  if (reason >= 0) return report;
  SNES snes = nullptr;
  SNESConvergedReason newton = SNES_CONVERGED_ITERATING;
  double step = 0;
  PetscInt iterations = 0;
  check(TSGetSNES(ts, &snes));
  check(SNESGetConvergedReason(snes, &newton));
  check(SNESGetIterationNumber(snes, &iterations));
  check(TSGetTimeStep(ts, &step));
  throw MotionStopped(
      fmt::format(
          "the motion stopped at t = {:.6g} of {:.6g}, after {} steps: the step of {:.3g} did not converge ({} after "
          "{} "
          "Newton iterations, {} steps tried again). The state at t = {:.6g} and all before it is kept. Try a smaller "
          "motion.step, or a tolerance for adaptive steps",
          report.end, how.end, report.steps, step, SNESConvergedReasons[newton], iterations, report.rejected,
          report.end),
      report);
}

}  // namespace floe::dynamics
