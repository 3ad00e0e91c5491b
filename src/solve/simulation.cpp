#include "floe/solve/simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <memory>
#include <utility>

#include "apply_event.h"
#include "crossings.h"
#include "floe/petsc/options.h"
#include "floe/solve/generalized_alpha.h"
#include "floe/solve/start.h"
#include "simplified_newton.h"

namespace floe::solve {

using petsc::check;

namespace {

struct Context {
  const System& system;
  const std::function<void(const Instant&)>& observe;
  const std::vector<Event>& events;
  const std::vector<Kink>& kinks;
  double end = 0;  ///< [s]
  bool adaptive = false;
  double nominal = 0;  ///< the fixed step [s]
  petsc::Guard guard = {};
  TS ts = nullptr;
  std::vector<double> carried_of_tangent = {};        ///< as it was when the last tangent was formed
  std::vector<Eigen::Matrix3d> axes_of_tangent = {};  ///< of frames, likewise
  std::function<MotionState()> state = {};
  std::function<void(double, Vec, Vec)> between = {};
  std::unique_ptr<Crossings> crossings = {};
  std::vector<double> happened = {};    ///< of each event
  bool observed = false;                ///< the instant that TS begins with, before a kink
  petsc::VecHandle accelerations = {};  ///< of the start, until the integrator takes them over
};

PetscErrorCode residual(TS, PetscReal t, Vec U, Vec V, Vec A, Vec F, void* context) {
  auto& c = *static_cast<Context*>(context);
  return c.guard.run([&] { c.system.residual(t, U, V, A, ConstraintLevel::position, F); });
}

PetscErrorCode tangent(TS, PetscReal t, Vec U, Vec V, Vec A, PetscReal shift_v, PetscReal shift_a, Mat J, Mat,
                       void* context) {
  auto& c = *static_cast<Context*>(context);
  return c.guard.run([&] {
    c.system.tangent(t, U, V, A, {1, shift_v, shift_a}, J);
    c.system.save(c.carried_of_tangent);
    c.system.frame_axes(U, c.axes_of_tangent);
  });
}

PetscErrorCode start(TS, PetscReal t, Vec U, Vec V, Vec A, void* context) {
  auto& c = *static_cast<Context*>(context);
  return c.guard.run([&] {
    if (const petsc::VecHandle known = std::move(c.accelerations))
      check(VecCopy(known, A));
    else
      consistent_start(c.system, t, U, V, A);
  });
}

PetscErrorCode rebase(TS, Vec U, void* context) {
  auto& c = *static_cast<Context*>(context);
  return c.guard.run([&] { c.system.rebase(U); });
}

PetscErrorCode bracket(TS, Vec a, Vec b, Vec W, void* context) {
  auto& c = *static_cast<Context*>(context);
  return c.guard.run([&] { c.system.bracket(a, b, W); });
}

PetscErrorCode turn(TS, Vec U, PetscBool back, Vec y, void* context) {
  auto& c = *static_cast<Context*>(context);
  return c.guard.run([&] { c.system.turn(c.axes_of_tangent, U, back == PETSC_TRUE, y); });
}

/// A step that ends where a joint is not met as it is meant to be is none. Adaptive ones that turn too far are tried
/// again, smaller.
PetscErrorCode well_met(TS ts, PetscReal t, Vec U, PetscBool* accept) {
  Context* c = nullptr;
  const PetscErrorCode code = TSGetApplicationContext(ts, &c);
  if (code) return code;
  return c->guard.run([&] {
    const System::Astray astray = c->system.astray(t, U);
    *accept = astray.joint.empty() ? PETSC_TRUE : PETSC_FALSE;
    if (astray.joint.empty() || (c->adaptive && astray.standing == Standing::half_turn)) return;
    throw RunError(fmt::format("at t = {:.6g} {}{}", t, astray.text(),
                               astray.standing == Standing::half_turn ? "; expected a smaller motion.step" : ""));
  });
}

/// A state that is not finite, or whose energy soon will not be, is none to go on from, or to end with.
void refuse_not_finite(Vec U, Vec V) {
  double sizes[2] = {0, 0};
  check(VecNorm(U, NORM_2, &sizes[0]));
  check(VecNorm(V, NORM_2, &sizes[1]));
  if (!(sizes[0] < beyond_numbers && sizes[1] < beyond_numbers))
    throw RunError(
        "the state is not finite. Try a smaller motion.step, and remove options -motion_snes_... and -motion_ts_... "
        "that stop Newton's method early");
}

PetscErrorCode monitor(TS ts, PetscInt step, PetscReal t, Vec U, void* context) {
  auto& c = *static_cast<Context*>(context);
  return c.guard.run([&] {
    if (std::exchange(c.observed, false)) return;
    if (c.crossings && c.crossings->going_back()) return;  // this instant was observed before
    if (step == 0) t = 0;                                  // not behind a kink that the motion begins with
    Vec V = nullptr, A = nullptr;
    check(TS2GetSolution(ts, nullptr, &V));
    check(TSGeneralizedAlphaGetAcceleration(ts, &A));
    refuse_not_finite(U, V);
    c.observe({t, step, U, V, A, t >= c.end * (1 - 1e-12),
               c.state && !(c.crossings && c.crossings->arrived()) ? &c.state : nullptr,
               c.between && A ? &c.between : nullptr});
  });
}

PetscErrorCode post_step(TS ts) {
  Context* c = nullptr;
  PetscFunctionBegin;
  PetscCall(TSGetApplicationContext(ts, &c));
  PetscCall(c->guard.run([&] { c->crossings->after_step(ts); }));
  PetscFunctionReturn(0);
}

std::string prefix_of(TS ts) {
  const char* prefix = nullptr;
  check(TSGetOptionsPrefix(ts, &prefix));
  return prefix ? prefix : "";
}

/// A factorisation serves several steps: generalized-alpha makes a new one as soon as Newton's rate is bad. In exchange
/// Newton goes on to 1e-10 of what a step adds to h v, so that the motion stays within some 1e-9 of full Newton's (what
/// the step neglects is far more); full order of up to 10,000 unknowns to 1e-11, so that its motion does not depend on
/// the number of ranks. On one rank KLU factors what fills in little several times faster than MUMPS: chains of beams,
/// some 10 entries a row; and shells, some 45, of up to 1500 unknowns (with 6,700 MUMPS is 1.6 times faster).
void save_factorisations(SNES snes, Mat J) {
  PetscInt unknowns = 0;
  PetscBool sequential_dense = PETSC_FALSE;
  check(MatGetSize(J, &unknowns, nullptr));
  check(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(J), MATSEQDENSE, &sequential_dense));
  const double tolerance = sequential_dense ? 1e-10 : unknowns < 10000 ? 1e-11 : 1e-9;
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
void refuse_other_types(TS ts, const System& system, const std::string& prefix) {
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
  const bool attitudes = system.has_attitudes();
  const TSGeneralizedAlphaRotations rotations{attitudes ? rebase : nullptr, attitudes ? bracket : nullptr, &context,
                                              turn};
  check(TSGeneralizedAlphaSetRotations(ts, &rotations));
  check(TSSetApplicationContext(ts, &context));
  check(TSSetFunctionDomainError(ts, well_met));
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
  save_factorisations(snes, J);
  petsc::check_options(TSSetFromOptions(ts), how.prefix);
  check(TSGetMaxTime(ts, &context.end));
  refuse_other_types(ts, system, how.prefix);
}

/// What to do about a step that no smaller one replaced.
std::string remedy(TS ts, const Context& context, bool newton_failed) {
  SNES snes = nullptr;
  SNESType type = nullptr;
  double tolerance = 0;
  check(TSGetSNES(ts, &snes));
  check(SNESGetType(snes, &type));
  check(TSGetTolerances(ts, nullptr, nullptr, &tolerance, nullptr));
  if (newton_failed && type != std::string(simplified_newton))
    return fmt::format("Remove option -{}snes_type {}, or try a smaller motion.step", prefix_of(ts), type);
  if (!context.adaptive) return "Try a smaller motion.step, or a tolerance for adaptive steps";
  return fmt::format("Try another motion.tolerance than {:.3g}, or a fixed motion.step", tolerance);
}

/// Ended by `reason`, which is no success: what happened and what was tried.
std::string ending(TS ts, TSConvergedReason reason, const Context& context, const IntegrationReport& report) {
  if (reason == TS_CONVERGED_ITS)
    return fmt::format("no more than {} steps are allowed (option -{}ts_max_steps)", report.steps, prefix_of(ts));
  SNES snes = nullptr;
  SNESConvergedReason newton = SNES_CONVERGED_ITERATING;
  double step = 0;
  PetscInt iterations = 0;
  check(TSGetSNES(ts, &snes));
  check(SNESGetConvergedReason(snes, &newton));
  check(SNESGetIterationNumber(snes, &iterations));
  check(TSGetTimeStep(ts, &step));
  if (newton >= 0)
    return fmt::format(
        "the error of a step of {:.3g} is above the tolerance ({} steps repeated; option -{}ts_max_reject). {}", step,
        report.rejected, prefix_of(ts), remedy(ts, context, false));
  return fmt::format(
      "the step of {:.3g} did not converge ({}{} after {} Newton iterations, {} steps repeated; options -{}snes_..., "
      "-{}ksp_...). {}",
      step, newton == SNES_DIVERGED_FNORM_NAN ? "the state is not finite: " : "", SNESConvergedReasons[newton],
      iterations, report.rejected, prefix_of(ts), prefix_of(ts), remedy(ts, context, true));
}

/// The first that the motion is not behind.
std::vector<Kink>::const_iterator next_kink(const Context& context, double t) {
  return std::partition_point(context.kinks.begin(), context.kinks.end(),
                              [&](const Kink& kink) { return kink.after <= t; });
}

/// The next event or kink at a time given, of those that have not happened; none: the motion's end.
double next_stop(const Context& context) {
  double next = context.end, t = 0;
  check(TSGetTime(context.ts, &t));
  const auto kink = next_kink(context, t);
  if (kink != context.kinks.end()) next = std::min(next, kink->before);
  for (std::size_t i = 0; i < context.events.size(); ++i)
    if (!context.events[i].watched() && context.happened[i] == 0) next = std::min(next, context.events[i].at);
  return next;
}

MotionState keep(const Context& context) {
  MotionState state;
  save_motion(context.ts, context.system, state);
  state.carried_of_tangent = context.carried_of_tangent;
  state.events = context.happened;
  state.stop = next_stop(context);
  return state;
}

void take_up(TS ts, const MotionState& state, Context& context) {
  petsc::agree(context.system.comm(), [&] {
    if (!context.state) throw InputError("only a simulation of type generalized-alpha can be restarted");
    if (state.events.size() != context.events.size())
      throw RunError("the saved state belongs to another system: its events differ");
  });
  check(TSSetUp(ts));
  load_motion(ts, context.system, state);
  context.carried_of_tangent = state.carried_of_tangent;
  context.happened = state.events;
  // Before an end steps are shorter, to meet it; where that is no end any more, they are whole again.
  if (!context.adaptive && next_stop(context) > state.stop * (1 + 1e-12)) check(TSSetTimeStep(ts, context.nominal));
}

/// Takes the motion over the kinks that are due.
bool pass_kinks(TS ts, const Integration& how, Context& context) {
  double t = 0;
  Vec U = nullptr, V = nullptr;
  PetscInt step = 0;
  check(TSGetTime(ts, &t));
  check(TSGetStepNumber(ts, &step));
  if (t >= context.end * (1 - 1e-12)) return false;
  const auto first = next_kink(context, t);
  auto kink = first;
  for (; kink != context.kinks.end() && kink->before <= t + 1e-12 * context.end; ++kink) {
    check(TS2GetSolution(ts, &U, &V));
    const EventReport report = pass(context.system, *kink, U, V);
    check(TSSetTime(ts, kink->after));
    context.observed = step > 0;
    if (!kink->what.empty() && how.on_event) how.on_event(report);
  }
  return kink != first;
}

/// Applies the events that are due. Returns whether the motion goes on.
bool act(TS ts, const Integration& how, Context& context, double nominal) {
  double t = 0;
  Vec U = nullptr, V = nullptr;
  bool changed = pass_kinks(ts, how, context), stopped = false;
  check(TSGetTime(ts, &t));
  check(TS2GetSolution(ts, &U, &V));
  for (std::size_t i = 0; i < context.events.size(); ++i) {
    const Event& event = context.events[i];
    const bool due = event.watched() ? context.crossings->located(i) : event.at <= t + 1e-12 * context.end;
    if (!due || context.happened[i] != 0) continue;
    const EventReport report = apply_event(context.system, event, t, U, V);
    context.happened[i] = 1;
    changed = true, stopped = stopped || event.stops;
    if (how.on_event) how.on_event(report);
  }
  if (!changed) return true;
  check(TSRestartStep(ts));
  if (!how.tolerance) check(TSSetTimeStep(ts, nominal));
  return !stopped;
}

/// Multipliers of the start into the solution, so that the first instant has them. Where they cannot be found, the
/// first step says why.
void find_start(TS ts, Context& context) {
  double t = 0;
  Vec U = nullptr, V = nullptr;
  check(TSGetTime(ts, &t));
  check(TS2GetSolution(ts, &U, &V));
  petsc::VecHandle A = context.system.create_vector();
  int found = 1;
  try {
    consistent_start(context.system, t, U, V, A);
  } catch (const RunError&) {
    found = 0;
  }
  check(MPI_Allreduce(MPI_IN_PLACE, &found, 1, MPI_INT, MPI_MIN, context.system.comm()));
  if (found) context.accelerations = std::move(A);
}

/// From event to event, to the end. Returns whether an event ended the motion before.
bool go(TS ts, const Integration& how, Context& context, double nominal) {
  double t = 0;
  while (true) {
    if (!act(ts, how, context, nominal)) return true;
    check(TSGetTime(ts, &t));
    if (t >= context.end * (1 - 1e-12)) return false;
    PetscInt steps = 0;
    check(TSGetStepNumber(ts, &steps));
    if (steps == 0 && context.state && !how.from) find_start(ts, context);
    if (context.crossings) context.crossings->begin(ts);
    const double stop = next_stop(context);
    double step = 0;
    check(TSGetTimeStep(ts, &step));
    if (t + step - stop > 1e-9 * step) check(TSSetTimeStep(ts, stop - t));  // TS looks at it after a step only
    check(TSSetMaxTime(ts, stop));
    context.guard.check(TSSolve(ts, nullptr));
    TSConvergedReason reason = TS_CONVERGED_ITERATING;
    check(TSGetConvergedReason(ts, &reason));
    if (reason != TS_CONVERGED_TIME && reason != TS_CONVERGED_USER) return false;
  }
}

}  // namespace

IntegrationReport simulate(const System& system, const Integration& how, Vec U, Vec V,
                           const std::function<void(const Instant&)>& observe) {
  Context context{system, observe, how.events, how.kinks, how.end, how.tolerance.has_value()};
  const petsc::VecHandle F = system.create_vector();
  const petsc::MatHandle J = system.create_tangent();
  petsc::TsHandle ts;
  check(TSCreate(system.comm(), ts.out()));
  set_up(ts, system, how, context, U, V, F, J);

  IntegrationReport report;
  TSType type = nullptr;
  check(TSGetType(ts, &type));
  report.type = type;
  context.ts = ts;
  if (report.type == generalized_alpha) {
    context.state = [&] { return keep(context); };
    context.between = [&](double t, Vec at, Vec rate) {
      check(TSGeneralizedAlphaInterpolate(context.ts, t, at, rate));
    };
  }
  context.happened.assign(how.events.size(), 0);
  double& nominal = context.nominal;
  check(TSGetTimeStep(ts, &nominal));
  if (std::any_of(how.events.begin(), how.events.end(), [](const Event& event) { return event.watched(); })) {
    context.crossings =
        std::make_unique<Crossings>(how.events, context.happened, how.tolerance ? 0 : nominal, how.on_event);
    check(TSSetPostStep(ts, post_step));
  }
  if (how.from) take_up(ts, *how.from, context);
  const double begin = MPI_Wtime();
  bool ended = false;
  const std::clock_t processor_begin = std::clock();
  const PetscErrorCode code = context.guard.run([&] { ended = go(ts, how, context, nominal); });
  report.seconds = MPI_Wtime() - begin;
  report.processor_seconds = static_cast<double>(std::clock() - processor_begin) / CLOCKS_PER_SEC;
  TSGetStepNumber(ts, &report.steps);
  TSGetTime(ts, &report.end);
  TSGetSNESIterations(ts, &report.newton);
  TSGetKSPIterations(ts, &report.solves);
  TSGetStepRejections(ts, &report.rejected);
  const auto stop = [&](const std::string& why) {
    throw MotionStopped(fmt::format("the simulation stopped at t = {:.6g} of {:.6g}, after {} steps: {}", report.end,
                                    context.end, report.steps, why),
                        report, why);
  };
  try {
    context.guard.check(code);
  } catch (const InputError&) {
    throw;
  } catch (const petsc::Error& error) {
    const std::string text = error.what();
    if (!is_singular(error.code()) || report.steps > 0) stop(text);
    stop(fmt::format("{} (options -{}ksp_...: {})", singular_start, how.prefix, text.substr(0, text.find('\n'))));
  } catch (const std::exception& error) {
    stop(error.what());
  }
  TSConvergedReason reason = TS_CONVERGED_ITERATING;
  check(TSGetConvergedReason(ts, &reason));
  if (ended) return report;
  if (reason < 0 || report.end < context.end * (1 - 1e-12)) stop(ending(ts, reason, context, report));
  return report;
}

}  // namespace floe::solve
