#include "floe/solve/simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <memory>
#include <utility>

#include "apply_event.h"
#include "floe/petsc/options.h"
#include "floe/solve/generalized_alpha.h"
#include "floe/solve/start.h"
#include "motion_context.h"
#include "simplified_newton.h"

namespace floe::solve {

using petsc::check;

namespace {

std::string prefix_of(TS ts) {
  const char* prefix = nullptr;
  check(TSGetOptionsPrefix(ts, &prefix));
  return prefix ? prefix : "";
}

/// What to do about a step that no smaller one replaced.
std::string remedy(TS ts, const MotionContext& context, bool newton_failed) {
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
std::string ending(TS ts, TSConvergedReason reason, const MotionContext& context, const IntegrationReport& report) {
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
std::vector<Kink>::const_iterator next_kink(const MotionContext& context, double t) {
  return std::partition_point(context.kinks.begin(), context.kinks.end(),
                              [&](const Kink& kink) { return kink.after <= t; });
}

/// The next event or kink at a time given, of those that have not happened; none: the motion's end.
double next_stop(const MotionContext& context) {
  double next = context.end, t = 0;
  check(TSGetTime(context.ts, &t));
  const auto kink = next_kink(context, t);
  if (kink != context.kinks.end()) next = std::min(next, kink->before);
  for (std::size_t i = 0; i < context.events.size(); ++i)
    if (!context.events[i].watched() && context.happened[i] == 0) next = std::min(next, context.events[i].at);
  return next;
}

MotionState keep(const MotionContext& context) {
  MotionState state;
  save_motion(context.ts, context.system, state);
  state.carried_of_tangent = context.carried_of_tangent;
  state.events = context.happened;
  state.stop = next_stop(context);
  return state;
}

void take_up(TS ts, const MotionState& state, MotionContext& context) {
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

struct PassedKinks {
  bool any = false;
  bool velocities = false;  ///< whether they jump
};

/// For damp_jump and give_way; 0: not known, since the error of adaptive steps decides.
double next_step(const MotionContext& context) { return context.adaptive ? 0 : context.nominal; }

/// Takes the motion over the kinks that are due.
PassedKinks pass_kinks(TS ts, const Integration& how, MotionContext& context) {
  PassedKinks passed;
  double t = 0;
  Vec U = nullptr, V = nullptr;
  PetscInt step = 0;
  check(TSGetTime(ts, &t));
  check(TSGetStepNumber(ts, &step));
  if (t >= context.end * (1 - 1e-12)) return passed;
  const double h = next_step(context);
  for (auto kink = next_kink(context, t); kink != context.kinks.end() && kink->before <= t + 1e-12 * context.end;
       ++kink) {
    check(TS2GetSolution(ts, &U, &V));
    const EventReport report = pass(context.system, *kink, h, U, V);
    passed.any = true, passed.velocities = passed.velocities || !kink->what.empty();
    check(TSSetTime(ts, kink->after));
    context.observed = step > 0;
    if (!kink->what.empty() && how.on_event) how.on_event(report);
  }
  return passed;
}

/// Applies the events that are due. Returns whether the motion goes on.
bool act(TS ts, const Integration& how, MotionContext& context, double nominal) {
  double t = 0;
  Vec U = nullptr, V = nullptr;
  const PassedKinks kinks = pass_kinks(ts, how, context);
  bool stopped = false;
  check(TSGetTime(ts, &t));
  check(TS2GetSolution(ts, &U, &V));
  std::vector<std::size_t> due;
  for (std::size_t i = 0; i < context.events.size(); ++i)
    if (context.happened[i] == 0 && is_due(context, i, t)) due.push_back(i);
  const auto releases = [&](std::size_t i) { return context.events[i].constraint_switch && !context.events[i].closes; };
  const double h = next_step(context);
  petsc::VecHandle before;  // what one event releases another one of the same instant may hold: both are one jump
  if (h > 0 && std::any_of(due.begin(), due.end(), releases) && context.system.damps_strains()) {
    const petsc::VecHandle other = context.system.create_vector();
    check(VecCopy(U, other));
    before = accelerations_at(context.system, t, other, V);
  }
  std::vector<EventReport> reports;
  std::size_t last = 0;  // of those that release a joint
  const auto report_all = [&] {
    for (const EventReport& report : reports)
      if (how.on_event) how.on_event(report);
  };
  try {
    for (const std::size_t i : due) {
      if (releases(i)) last = reports.size();
      reports.push_back(apply_event(context.system, context.events[i], t, h, U, V));
      context.happened[i] = 1;
      stopped = stopped || context.events[i].stops;
    }
    if (before) reports[last].released = give_way(context.system, t, h, U, before, V);
  } catch (const RunError&) {  // on all ranks: what has happened before is reported
    report_all();
    throw;
  }
  report_all();
  const bool applied = !due.empty();
  if (!kinks.any && !applied) return true;
  if (!kinks.velocities && !applied) check(TSGeneralizedAlphaSetForcesJump(ts));
  check(TSRestartStep(ts));
  if (!how.tolerance) check(TSSetTimeStep(ts, nominal));
  return !stopped;
}

/// Multipliers of the start into the solution, so that the first instant has them. Where they cannot be found, the
/// first step says why.
void find_start(TS ts, MotionContext& context) {
  double t = 0;
  Vec U = nullptr, V = nullptr;
  check(TSGetTime(ts, &t));
  check(TS2GetSolution(ts, &U, &V));
  if (petsc::VecHandle A = accelerations_at(context.system, t, U, V)) context.accelerations = std::move(A);
}

/// From event to event, to the end. Returns whether an event ended the motion before.
bool go(TS ts, const Integration& how, MotionContext& context, double nominal) {
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
  MotionContext context{system, observe, how.events, how.kinks, how.end, how.tolerance.has_value()};
  const petsc::VecHandle F = system.create_vector();
  const petsc::MatHandle J = system.create_tangent();
  petsc::TsHandle ts;
  check(TSCreate(system.comm(), ts.out()));
  set_up_motion(ts, system, how, context, U, V, F, J);

  IntegrationReport report;
  TSType type = nullptr;
  check(TSGetType(ts, &type));
  report.type = type;
  context.ts = ts;
  if (report.type == generalized_alpha) {
    context.state = [&] { return keep(context); };
    context.between = [&](double t, Vec at, Vec rate, Vec second_rate) {
      check(TSGeneralizedAlphaInterpolate(context.ts, t, at, rate, second_rate));
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
    const std::vector<char>& multiplier = system.coordinates().multiplier();
    if (error.code() == PETSC_ERR_MAT_LU_ZRPVT && report.steps > 0 &&
        std::find(multiplier.begin(), multiplier.end(), 1) != multiplier.end())
      stop(fmt::format(
          "the equations of a step are singular: the mechanism is in a position in which the constraints of "
          "its joints depend on one another (cranks in line with their rod), or they are redundant ({})",
          text.substr(0, text.find('\n'))));
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
