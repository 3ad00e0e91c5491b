#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "floe/petsc/options.h"
#include "floe/solve/generalized_alpha.h"
#include "floe/solve/start.h"
#include "motion_context.h"
#include "simplified_newton.h"

namespace floe::solve {

using petsc::check;

namespace {

PetscErrorCode residual(TS, PetscReal t, Vec U, Vec V, Vec A, Vec F, void* context) {
  auto& c = *static_cast<MotionContext*>(context);
  return c.guard.run([&] { c.system.residual(t, U, V, A, ConstraintLevel::position, F); });
}

PetscErrorCode tangent(TS, PetscReal t, Vec U, Vec V, Vec A, PetscReal shift_v, PetscReal shift_a, Mat J, Mat,
                       void* context) {
  auto& c = *static_cast<MotionContext*>(context);
  return c.guard.run([&] {
    c.system.tangent(t, U, V, A, {1, shift_v, shift_a}, J);
    c.system.save(c.carried_of_tangent);
    c.system.frame_axes(U, c.axes_of_tangent);
  });
}

PetscErrorCode start(TS, PetscReal t, Vec U, Vec V, Vec A, void* context) {
  auto& c = *static_cast<MotionContext*>(context);
  return c.guard.run([&] {
    if (const petsc::VecHandle known = std::move(c.accelerations))
      check(VecCopy(known, A));
    else
      consistent_start(c.system, t, U, V, A);
  });
}

/// Of frames in the plane, those that this rank owns. Collective.
petsc::IsHandle frame_angles(const System& system, Vec U) {
  PetscInt first = 0, last = 0;
  check(VecGetOwnershipRange(U, &first, &last));
  std::vector<PetscInt> mine;
  for (const auto& [local, of_frame] : system.coordinates().angles())
    if (const PetscInt index = system.coordinates().global()[local]; of_frame && index >= first && index < last)
      mine.push_back(index);
  petsc::IsHandle set;
  check(ISCreateGeneral(system.comm(), static_cast<PetscInt>(mine.size()), mine.data(), PETSC_COPY_VALUES, set.out()));
  return set;
}

PetscErrorCode rebase_rotations(TS ts, Vec U, void* context) {
  auto& c = *static_cast<MotionContext*>(context);
  return c.guard.run([&] {
    PetscReal t = 0;
    Vec same = nullptr, V = nullptr;
    check(TSGetTime(ts, &t));
    check(TS2GetSolution(ts, &same, &V));
    c.system.rebase(U, V, t);
  });
}

PetscErrorCode bracket(TS, Vec a, Vec b, Vec W, void* context) {
  auto& c = *static_cast<MotionContext*>(context);
  return c.guard.run([&] { c.system.bracket(a, b, W); });
}

PetscErrorCode rotate_rates(TS, Vec U, PetscBool back, Vec y, void* context) {
  auto& c = *static_cast<MotionContext*>(context);
  return c.guard.run([&] { c.system.rotate(c.axes_of_tangent, U, back == PETSC_TRUE, y); });
}

/// A step that ends where a joint is not met as it is meant to be, or in which a node rotates by more than half a
/// revolution, is none. Adaptive ones that rotate too far are tried again, smaller.
PetscErrorCode check_step(TS ts, PetscReal t, Vec U, PetscBool* accept) {
  MotionContext* c = nullptr;
  const PetscErrorCode code = TSGetApplicationContext(ts, &c);
  if (code) return code;
  return c->guard.run([&] {
    if (const double rotation = c->system.greatest_node_rotation(U); rotation > M_PI) {
      *accept = PETSC_FALSE;
      if (c->adaptive) return;
      throw RunError(fmt::format(
          "at t = {:.6g} the solution of the step rotates a node by {:.3g} rad (limit 3.14, half a revolution); take "
          "shorter steps or a tolerance, or let a sudden load grow within some steps: a moment on a node rotates it "
          "the more, the smaller its elements",
          t, rotation));
    }
    const System::FailedConstraint failed_constraint = c->system.failed_constraint(t, U);
    *accept = failed_constraint.joint.empty() ? PETSC_TRUE : PETSC_FALSE;
    if (failed_constraint.joint.empty() ||
        (c->adaptive && failed_constraint.constraint_status == ConstraintStatus::flipped_branch))
      return;
    throw RunError(fmt::format("at t = {:.6g} {}{}", t, failed_constraint.text(),
                               failed_constraint.constraint_status == ConstraintStatus::flipped_branch
                                   ? "; expected a smaller motion.step"
                                   : ""));
  });
}

/// Stops at a state that is not finite, or whose energy would overflow.
void refuse_not_finite(Vec U, Vec V) {
  double sizes[2] = {0, 0};
  check(VecNorm(U, NORM_2, &sizes[0]));
  check(VecNorm(V, NORM_2, &sizes[1]));
  if (!(sizes[0] < beyond_numbers && sizes[1] < beyond_numbers))
    throw RunError(
        "the state is not finite, or its numbers are beyond 1e50 (out of reach of double precision): the steps did not "
        "converge (unstable time integration). Try a smaller motion.step, remove options -motion_snes_... and "
        "-motion_ts_... that stop Newton's method early, or take units in which forces are smaller");
}

/// Whether the motion ends at t: there, or by an event.
bool ends_motion(const MotionContext& context, double t) {
  if (t >= context.end * (1 - 1e-12)) return true;
  for (std::size_t i = 0; i < context.events.size(); ++i) {
    const Event& event = context.events[i];
    if (event.stops && context.happened[i] == 0 && is_due(context, i, t)) return true;
  }
  return false;
}

PetscErrorCode monitor(TS ts, PetscInt step, PetscReal t, Vec U, void* context) {
  auto& c = *static_cast<MotionContext*>(context);
  return c.guard.run([&] {
    if (std::exchange(c.observed, false)) return;
    if (c.crossings && c.crossings->going_back()) return;  // this instant was observed before
    if (step == 0) t = 0;                                  // not behind a kink that the motion begins with
    Vec V = nullptr, A = nullptr;
    check(TS2GetSolution(ts, nullptr, &V));
    double event_error = 0;
    check(TSGeneralizedAlphaGetAcceleration(ts, &A));
    check(TSGeneralizedAlphaGetEventError(ts, &event_error));
    refuse_not_finite(U, V);
    c.observe({t, step, U, V, A, ends_motion(c, t),
               c.state && !(c.crossings && c.crossings->arrived()) ? &c.state : nullptr,
               c.between && A ? &c.between : nullptr, false, event_error});
  });
}

/// A factorisation serves several steps: generalized-alpha makes a new one as soon as Newton's rate is bad. In exchange
/// Newton goes on to 1e-10 of what a step adds to h v, so that the motion stays within some 1e-9 of full Newton's (what
/// the step neglects is far more); full order of up to 10,000 unknowns to 1e-11, so that its motion does not depend on
/// the number of ranks. On one rank KLU factors what fills in little several times faster than MUMPS: chains of beams,
/// some 10 entries a row; and shells, some 45, of up to 1500 unknowns (with 6,700 MUMPS is 1.6 times faster).
void save_factorisations(SNES snes, Mat J, double coarse) {
  PetscInt unknowns = 0;
  PetscBool sequential_dense = PETSC_FALSE;
  check(MatGetSize(J, &unknowns, nullptr));
  check(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(J), MATSEQDENSE, &sequential_dense));
  const double tolerance = std::max(coarse, sequential_dense ? 1e-10 : unknowns < 10000 ? 1e-11 : 1e-9);
  check(SNESSetLagJacobian(snes, 20));
  check(SNESSetLagJacobianPersists(snes, PETSC_TRUE));
  check(SNESSetTolerances(snes, PETSC_DEFAULT, tolerance, PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT));
  PetscBool sparse = PETSC_FALSE;
  check(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(J), MATSEQAIJ, &sparse));
  if (!sparse) return;
  MatInfo info;
  check(MatGetInfo(J, MAT_LOCAL, &info));
  if (unknowns > 1500 && info.nz_used > 25.0 * static_cast<double>(unknowns)) return;
  KSP ksp = nullptr;
  PC pc = nullptr;
  check(SNESGetKSP(snes, &ksp));
  check(KSPGetPC(ksp, &pc));
  check(PCFactorSetMatSolverType(pc, MATSOLVERKLU));
}

/// What -motion_ts_type may say: a type for motions, which are of second order, and one that knows rotations in space.
/// Newton's convergence test measures Newton's updates; a step that passes the end, or an event, would be lost.
void refuse_other_types(TS ts, const System& system, const Integration& how) {
  const std::string& prefix = how.prefix;
  SNES snes = nullptr;
  SNESType newton = nullptr;
  KSP ksp = nullptr;
  TSExactFinalTimeOption at_end = TS_EXACTFINALTIME_MATCHSTEP;
  check(TSGetExactFinalTime(ts, &at_end));
  if (at_end != TS_EXACTFINALTIME_MATCHSTEP)
    throw InputError(
        fmt::format("option -{}ts_exact_final_time: a simulation ends, and is interrupted by events, at the end of a "
                    "step; expected matchstep",
                    prefix));
  check(TSGetSNES(ts, &snes));
  check(SNESGetType(snes, &newton));
  if (newton != std::string(simplified_newton) && newton != std::string(SNESNEWTONLS))
    throw InputError(fmt::format(
        "option -{}snes_type {}: the convergence test for steps uses the size of Newton's updates; expected {} "
        "or {}",
        prefix, newton, simplified_newton, SNESNEWTONLS));
  check(SNESGetKSP(snes, &ksp));
  petsc::refuse_preconditioner_alone(ksp);
  PetscBool second_order = PETSC_FALSE;
  check(PetscObjectTypeCompareAny(reinterpret_cast<PetscObject>(ts), &second_order, generalized_alpha, TSALPHA2, ""));
  TSType type = nullptr;
  check(TSGetType(ts, &type));
  if (!second_order)
    throw InputError(
        fmt::format("option -{}ts_type {}: integrates first-order systems, and the equations of motion are of second "
                    "order; expected {} or {}",
                    prefix, type, generalized_alpha, TSALPHA2));
  if (system.has_attitudes() && type != std::string(generalized_alpha))
    throw InputError(fmt::format("option -{}ts_type {}: adds spatial rotations like vectors; expected {}", prefix, type,
                                 generalized_alpha));
  const auto watched =
      std::find_if(how.events.begin(), how.events.end(), [](const Event& one) { return one.watched(); });
  if (watched != how.events.end() && type != std::string(generalized_alpha))
    throw InputError(
        fmt::format("option -{}ts_type {}: does not interpolate within steps, where the time of event {} is found; "
                    "expected {}",
                    prefix, type, watched->name, generalized_alpha));
}

}  // namespace

PetscErrorCode post_step(TS ts) {
  MotionContext* c = nullptr;
  PetscFunctionBegin;
  PetscCall(TSGetApplicationContext(ts, &c));
  PetscCall(c->guard.run([&] { c->crossings->after_step(ts); }));
  PetscFunctionReturn(0);
}

void set_up_motion(TS ts, const System& system, const Integration& how, MotionContext& context, Vec U, Vec V, Vec F,
                   Mat J) {
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
  const bool attitudes = system.has_attitudes();
  const petsc::IsHandle angles = frame_angles(system, U);
  const TSGeneralizedAlphaRotations rotations{attitudes ? rebase_rotations : nullptr, attitudes ? bracket : nullptr,
                                              &context, rotate_rates, angles};
  check(TSGeneralizedAlphaSetRotations(ts, &rotations));
  if (how.state_loads) check(TSGeneralizedAlphaSetStateLoads(ts));
  check(TSSetApplicationContext(ts, &context));
  check(TSSetFunctionDomainError(ts, check_step));
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
  check(SNESGetKSP(snes, &ksp));
  set_tangent_solver(ksp, J);
  save_factorisations(snes, J, how.newton_tolerance);
  petsc::check_options(TSSetFromOptions(ts), how.prefix);
  check(TSGetMaxTime(ts, &context.end));
  refuse_other_types(ts, system, how);
}

}  // namespace floe::solve
