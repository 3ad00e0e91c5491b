#include "run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>

#include "error_budget.h"
#include "floe/math/rounded.h"
#include "floe/output/progress.h"
#include "floe/petsc/together.h"
#include "floe/solve/generalized_alpha.h"
#include "interruption.h"
#include "recorder.h"
#include "run_summary.h"

namespace floe::app {

using nlohmann::ordered_json;

namespace {

std::string columns_label(const assembly::Model& model) {
  int count[3] = {0, 0, 0}, responses = 0;
  for (const auto& body : model.bodies)
    for (const auto& origin : body.origins)
      if (origin.kept) ++(origin.label.starts_with("response ") ? responses : count[static_cast<int>(origin.kind)]);
  std::string label = fmt::format("{} VMs", count[0]);
  if (count[2]) label += fmt::format(" + {} AMs", count[2]);
  if (count[1]) label += fmt::format(" + {} MDs", count[1]);
  if (responses) label += fmt::format(" + {} responses", responses);
  return label;
}

/// What the offline stage does, for those who wait for it.
std::string offline_words(const scene::Scene& scene, scene::Formulation formulation) {
  if (!scene::is_reduced(formulation)) return "assembling " + scene::name_of(formulation);
  std::vector<std::string> names;
  for (const auto& body : scene.bodies)
    if (is_meshed(body)) names.push_back(body.name);
  if (names.empty()) return "assembling " + scene::name_of(formulation);
  if (names.size() == 1) return "reducing body " + names[0];
  return fmt::format("reducing {} bodies", names.size());
}

std::exception_ptr fault_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const std::exception&) {
    return std::current_exception();
  }
  return nullptr;
}

std::string text_of(const std::exception_ptr& fault) {
  if (!fault) return "";
  try {
    std::rethrow_exception(fault);
  } catch (const std::exception& error) {
    return error.what();
  }
}

/// Warns where the finished motion leaves the range of its model. Collective.
void check_range(const scene::Scene& scene, const assembly::Model& model, const assess::KeptMotion& kept, MPI_Comm comm,
                 const RunPlan& plan, RunResult& result) {
  std::string part;
  const std::string why =
      petsc::failed_together(comm, [&] { result.out_of_range = assess::out_of_range(scene, model, kept, comm, part); });
  if (!why.empty()) result.out_of_range.clear();
  if (!why.empty()) result.warnings.push_back("the model's validity was not checked: " + why);
  if (!part.empty()) result.warnings.push_back("part of the model's validity was not checked: " + part);
  if (plan.measured)
    std::erase_if(result.out_of_range, [](const assess::OutOfRange& one) { return !assess::also_of_full_order(one); });
  for (const assess::OutOfRange& one : result.out_of_range) result.warnings.push_back(one.text);
  if (plan.from) result.warnings.push_back("the model's validity was checked only after the restart");
}

}  // namespace

std::string label_of(const assembly::Model& model) {
  const auto from_file = [](const assembly::BodyReport& body) { return !body.file.empty(); };
  const auto meshed = [&](const assembly::BodyReport& body) { return !body.rigid && !from_file(body); };
  switch (model.formulation) {
    case scene::Formulation::cfr:
      return "CFR";
    case scene::Formulation::nlffr:
      return "NLFFR";
    case scene::Formulation::lffr:
      if (std::any_of(model.bodies.begin(), model.bodies.end(), meshed) ||
          std::none_of(model.bodies.begin(), model.bodies.end(), from_file))
        return "LFFR";
      return "LFFR on " + columns_label(model);
    default:
      return columns_label(model);
  }
}

RunResult run(const scene::Scene& scene, scene::Formulation formulation, MPI_Comm comm,
              const std::optional<output::ResultFolder>& folder, const RunPlan& plan) {
  const double begin = MPI_Wtime();
  const std::clock_t clock = std::clock();
  assembly::Model model = [&] {
    const output::Waiting waiting(comm, offline_words(scene, formulation));
    return assembly::build(scene, formulation, comm, plan.estimate || plan.check_range);
  }();
  RunPlan moving = plan;
  moving.offline_processor = static_cast<double>(std::clock() - clock) / CLOCKS_PER_SEC;
  return move(scene, model, MPI_Wtime() - begin, comm, folder, moving);
}

RunResult move(const scene::Scene& scene, assembly::Model& model, double offline_seconds, MPI_Comm comm,
               const std::optional<output::ResultFolder>& folder, const RunPlan& plan) {
  RunResult result;
  const double end = plan.until.value_or(scene.motion.end);
  result.offline_seconds = offline_seconds;
  result.label = label_of(model);
  result.coordinates = model.coordinates;
  result.warnings = model.warnings;
  if (const std::string changed = changed_start(scene, model); !changed.empty() && !plan.from)
    result.warnings.push_back(changed);
  result.series.columns = assembly::probe_columns(model);

  assess::KeptMotion kept(model, scene::is_reduced(model.formulation) ? 4000 : 100);
  const bool keeps =
      (plan.estimate || plan.check_range || plan.keep_states) && model.formulation != scene::Formulation::cfr;
  Recorder recorder(scene, model, comm, folder, result, plan);
  solve::Integration how{end, scene.motion.step, scene.motion.spectral_radius, scene.motion.tolerance};
  how.newton_tolerance = plan.newton_tolerance;
  how.state_loads =
      std::any_of(scene.loads.begin(), scene.loads.end(), [](const scene::Load& load) { return load.has_sensors(); });
  how.events = assembly::events_of(scene, model, end);
  how.kinks = assembly::kinks_of(scene, end);
  how.on_event = [&](const dynamics::EventReport& event) {
    recorder.note(event);
    if (keeps) kept.note(event);
  };
  const bool estimates = plan.estimate && !plan.from;
  std::optional<solve::State> start;
  if (estimates && plan.budget) start = assess::start_of(model);
  const std::optional<solve::MotionState> from =
      plan.from ? std::optional(state_of(*plan.from)) : std::optional<solve::MotionState>();
  if (from) how.from = &*from;
  solve::IntegrationReport report;
  // Reduced, every rank moves its own copy and rank 0 writes; a fault of one is everybody's, at the latest so many
  // steps later.
  constexpr PetscInt steps_alone = 1024;
  const bool reduced = scene::is_reduced(model.formulation);
  bool told = false;  // of the fault of another rank
  std::exception_ptr fault;
  {
    const Interruption interruption;
    std::optional<output::Progress> progress;
    if (!plan.quiet) progress.emplace(comm, 0, end);
    const auto observe = [&](const solve::Instant& instant) {
      recorder.observe(instant);
      if (keeps) kept.keep(instant);
      if (progress) progress->update(instant.t, instant.step);
      recorder.checkpoint_if_due(instant, [&] { return interruption.happened(reduced ? MPI_COMM_SELF : comm); });
      interruption.check(reduced ? MPI_COMM_SELF : comm);
      if (!reduced || instant.step % steps_alone != steps_alone - 1) return;
      told = true;
      petsc::agree(comm, [] {});
      told = false;
    };
    std::optional<std::string> reason;
    fault = fault_of([&] {
      try {
        report = solve::simulate(*model.system, how, model.U, model.V, observe);
      } catch (const solve::MotionStopped& error) {
        report = error.report();
        reason = error.reason();
        if (model.stretched_start.empty()) throw;
        throw solve::MotionStopped(fmt::format("{}; {}", error.what(), model.stretched_start), error.report(), *reason);
      }
    });
    if (reduced && !told) {
      const std::exception_ptr shared = fault_of([&] {
        petsc::agree(comm, [&] {
          if (reason) throw RunError(*reason);  // when it stopped here is another time than elsewhere
          if (fault) std::rethrow_exception(fault);
        });
      });
      if (!reason) fault = shared;
    }
  }
  if (report.type == TSALPHA2)
    result.warnings.push_back(
        "-motion_ts_type alpha2: before release 3.22 PETSc's integrator starts with a wrong acceleration, which "
        "reduces it to first order; multipliers may oscillate");
  if (scene.motion.output && report.type != solve::generalized_alpha)
    result.warnings.push_back(
        fmt::format("motion.output: PETSc's integrator {} does not interpolate within steps; only those output times "
                    "are stored at which a step ends",
                    report.type));
  result.steps = report.steps;
  result.end = report.end;
  result.motion_seconds = report.seconds - recorder.seconds();
  result.motion_processor = result.motion_seconds;
  if (report.processor_seconds > 0 && report.seconds > 0)  // zero: the clock of a virtual machine was stopped
    result.motion_processor *= report.processor_seconds / report.seconds;  // recording has the same share
  if (!petsc::all_arrive(comm, fault ? 10 : std::numeric_limits<double>::infinity()))
    std::rethrow_exception(fault);  // a fault of this rank alone: the others cannot help to finish the files
  for (const std::string& warning : {recorder.growth_warning(), recorder.event_warning()})
    if (!warning.empty()) result.warnings.push_back(warning);
  if (plan.keep_states) result.states = kept.states();
  if (plan.estimate && plan.from) result.estimate.none = "the run was restarted from a checkpoint";
  const bool assesses = !fault && (estimates || plan.check_range);
  const std::exception_ptr later = fault_of([&] {
    const auto keep = [&] { recorder.observe({report.end, report.steps, model.U, model.V, nullptr, true}); };
    const std::exception_ptr lost = fault_of([&] {
      if (fault) reduced ? petsc::agree(comm, keep) : keep();
    });
    recorder.finish(report, text_of(fault), assesses);
    if (lost) std::rethrow_exception(lost);
  });
  if (!fault && later) std::rethrow_exception(later);  // else the first fault is the one to report
  if (fault) std::rethrow_exception(fault);
  if (!assesses) return result;
  ordered_json budget;
  try {
    if (plan.check_range) check_range(scene, model, kept, comm, plan, result);
    if (estimates) {
      const output::Waiting waiting(comm, "estimating the error");
      const double seconds = plan.estimate_seconds.value_or(
          assess::estimate_seconds(result.offline_seconds + result.motion_seconds + recorder.seconds()));
      result.impulsive = kept.impulsive();
      if (kept.changes().empty() && !(kept.impulsive() && plan.budget))
        result.estimate = assess::estimate_error(model, kept, seconds);
      else
        result.estimate.none = kept.changes().empty() ? "impulses change the velocities" : "events change the joints";
      if (start)
        budget = error_budget({scene, model, *start, how, report.steps, report.processor_seconds,
                               plan.offline_processor.value_or(offline_seconds), comm},
                              kept, plan.no_model, result, plan.required, plan.made_rigid);
    }
  } catch (const std::exception& error) {  // of this rank alone: the others cannot help to say so
    recorder.conclude_alone(error.what());
    throw;
  }
  recorder.conclude(budget);
  return result;
}

}  // namespace floe::app
