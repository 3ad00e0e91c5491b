#include "equilibrium.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <optional>

#include "error_budget.h"
#include "estimate_words.h"
#include "floe/output/progress.h"
#include "floe/output/table.h"
#include "floe/petsc/rank.h"
#include "floe/petsc/together.h"
#include "floe/solve/branch.h"
#include "floe/solve/start.h"
#include "interruption.h"
#include "load_path.h"
#include "recorder.h"

namespace floe::app {
namespace {

using petsc::check;

/// The scene with its steps of load where a motion's steps would stand: the recorder keeps every one.
scene::Scene in_steps(scene::Scene scene, const LoadSteps& load) {
  scene.motion.end = load.at, scene.motion.step = load.at / load.steps, scene.motion.every = 1;
  scene.motion.output.reset();
  scene.motion.tolerance.reset();
  return scene;
}

double seconds_since(std::clock_t begin) { return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC; }

/// Says once from which t on the equilibria give way, or that nobody looks.
void warn_of_instability(const assembly::Model& model, double t, RunResult& result) {
  if (result.summary.contains("unstable_from")) return;
  const std::optional<int> looked = solve::unstable_directions(*model.system, t, model.U, model.V);
  result.summary["stability"] = looked ? "looked at" : "not looked at: the tangent is not symmetric, or has no factor";
  const int directions = looked.value_or(0);
  if (directions == 0) return;
  result.summary["unstable_from"] = t;
  result.warnings.push_back(
      fmt::format("the equilibrium at t = {:.6g} is unstable in {} {}: small disturbances grow. Start nearer to a "
                  "stable equilibrium (`initial`), or simulate a damped motion until it comes to rest",
                  t, directions, directions == 1 ? "direction" : "directions"));
}

/// Says of a jump where it is and what the probe that it changes most did.
void warn_of_jump(const assembly::Model& model, const solve::BranchJump& jump, Vec before, Vec after,
                  RunResult& result) {
  const std::vector<double> was = assembly::probe_values(model, jump.from, before, model.V, model.V),
                            is = assembly::probe_values(model, jump.to, after, model.V, model.V);
  std::size_t most = 0;
  for (std::size_t i = 1; i < is.size(); ++i)
    if (std::abs(is[i] - was[i]) > std::abs(is[most] - was[most])) most = i;
  const std::string probe =
      is.empty() ? ""
                 : fmt::format(" ({} from {:.4g} to {:.4g})", result.series.columns[most].name, was[most], is[most]);
  const std::string words = fmt::format(
      "the equilibrium jumps between t = {:.6g} and {:.6g}{}: the change is {:.2g} times that predicted by the "
      "tangents (limit {:.2g}), because of snap-through or a discontinuous load. The equilibria after it belong to "
      "another branch, which need not be the only one; follow the path between them (--path), or simulate the "
      "snap-through as a damped motion (floe run)",
      jump.from, jump.to, probe, jump.ratio, solve::least_jump);
  result.warnings.push_back(words);
  if (!result.summary.contains("jumps")) result.summary["jumps"] = nlohmann::ordered_json::array();
  result.summary["jumps"].push_back({{"from", jump.from}, {"to", jump.to}, {"ratio", jump.ratio}});
}

/// The equilibrium at t = 0. Where no load has grown yet that would hold the configuration there is none that is
/// determined: then U stays at the start, and the note says so.
std::string start_of_table(const assembly::Model& model, const LoadSteps& load, PetscInt& iterations) {
  try {
    iterations += solve::equilibrium(*model.system, 0, model.U, model.V, true);
  } catch (const solve::Unconstrained& error) {
    return fmt::format("{}: the table begins at t = {:.6g}",
                       std::string(error.what()).substr(0, std::string(error.what()).rfind(';')), load.at / load.steps);
  }
  return "";
}

std::string without_events(const scene::Scene& scene) {
  std::vector<std::string> names;
  for (const scene::Event& event : scene.events) names.push_back(event.name);
  return fmt::format("equilibria do not take account of events ({}): joints are as at the start",
                     fmt::join(names, ", "));
}

}  // namespace

RunResult rest(const scene::Scene& given, scene::Formulation formulation, MPI_Comm comm, const LoadSteps& load,
               const std::optional<output::ResultFolder>& folder, bool estimate) {
  const scene::Scene scene = in_steps(given, load);
  RunResult result;
  const double begin = MPI_Wtime();
  const std::clock_t clock = std::clock();
  assembly::Model model = [&] {
    const output::Waiting waiting(comm, "preparing " + scene::name_of(formulation));
    return assembly::build(scene, formulation, comm, true);
  }();
  check(VecSet(model.V, 0));
  result.offline_seconds = MPI_Wtime() - begin;
  const double offline = seconds_since(clock);
  result.label = label_of(model);
  result.coordinates = model.coordinates;
  result.warnings = model.warnings;
  if (!scene.events.empty()) result.warnings.push_back(without_events(scene));
  result.series.columns = assembly::probe_columns(model);
  Recorder recorder(scene, model, comm, folder, result);
  assess::KeptMotion kept(model, 100);
  solve::IntegrationReport report;
  report.type = "static";
  std::exception_ptr fault;
  std::string why;
  const double started = MPI_Wtime();
  const std::clock_t search = std::clock();
  try {
    const Interruption interruption;
    output::Progress progress(comm, 0, load.at);
    const std::string none = start_of_table(model, load, report.newton);
    if (none.empty())
      recorder.observe({0, 0, model.U, model.V, nullptr, false, nullptr, nullptr, true});
    else
      result.warnings.push_back(none);
    if (load.path) follow_load_path(model, load, none.empty(), recorder, kept, report, result);
    for (int step = 1; step <= load.steps && !load.path; ++step) {
      const double t = load.at * step / load.steps;
      report.newton += solve::follow_equilibrium(*model.system, report.end, t, load.at / 1000, model.U, model.V,
                                                 [&](const solve::BranchJump& jump, Vec before, Vec after) {
                                                   if (step > 1 || none.empty())
                                                     warn_of_jump(model, jump, before, after, result);
                                                 });
      report.steps = step, report.end = t;
      warn_of_instability(model, t, result);
      recorder.observe({t, step, model.U, model.V, nullptr, step == load.steps, nullptr, nullptr, true});
      kept.keep({t, step, model.U, model.V, model.V, step == load.steps});  // at rest
      progress.update(t, step);
      interruption.check(comm);
    }
  } catch (const std::exception& error) {
    fault = std::current_exception(), why = error.what();
  }
  report.seconds = MPI_Wtime() - started, report.processor_seconds = seconds_since(search);
  result.steps = report.steps, result.end = report.end, result.motion_seconds = report.seconds - recorder.seconds();
  recorder.finish(report, why, !fault);
  if (fault) std::rethrow_exception(fault);
  nlohmann::ordered_json budget;
  try {
    const std::string unchecked = petsc::failed_together(
        comm, [&] { result.out_of_range = assess::shapes_out_of_range(model, kept.states(), comm); });
    if (!unchecked.empty()) result.warnings.push_back("the model's validity was not checked: " + unchecked);
    for (const assess::OutOfRange& one : result.out_of_range) result.warnings.push_back(one.text);
    if (load.path) {
      result.estimate.none =
          "a path of equilibria is not estimated: beyond limit points the full-order model has several equilibria at "
          "the same t";
    } else if (estimate) {
      const output::Waiting waiting(comm, "estimating the error");
      result.estimate = assess::estimate_error_at_rest(
          model, kept.states(),
          assess::estimate_seconds(result.offline_seconds + result.motion_seconds + recorder.seconds()));
      solve::Integration how;
      how.end = load.at, how.step = scene.motion.step;
      if (scene::is_reduced(formulation))
        budget = error_budget({scene, model, {}, how, report.steps, report.processor_seconds, offline, comm, true},
                              kept, "", result);
    }
  } catch (const std::exception& error) {  // of this rank alone: the others cannot help to say so
    recorder.conclude_alone(error.what());
    throw;
  }
  recorder.conclude(budget);
  return result;
}

void solve_static(const scene::Scene& scene, scene::Formulation formulation, MPI_Comm comm, const LoadSteps& load,
                  const output::ResultFolder& folder, bool estimate) {
  RunResult result;
  try {
    result = rest(scene, formulation, comm, load, folder, estimate);
  } catch (const std::exception&) {
    output::discard_if_empty(folder);
    throw;
  }
  if (!petsc::first_rank(comm)) return;
  fmt::print("{} as {} ({}): {} coordinates, {} equilibria to t = {}, {} Newton iterations\n",
             scene.title.empty() ? scene.file : scene.title, scene::name_of(formulation), result.label,
             result.coordinates, result.steps, result.end,
             result.summary["integration"]["newton_iterations"].get<PetscInt>());
  fmt::print("offline {:.3g} s, equilibria {:.3g} s\n\n", result.offline_seconds, result.motion_seconds);
  output::Table table;
  table.columns = {{"t", "", 6}};
  const std::size_t shown = std::min<std::size_t>(result.series.columns.size(), 6);
  for (std::size_t c = 0; c < shown; ++c)
    table.columns.push_back({result.series.columns[c].name, result.series.columns[c].unit, 6});
  for (std::size_t i = 0; i < result.series.t.size(); ++i) {
    std::vector<output::Cell>& row = table.rows.emplace_back();
    row.emplace_back(result.series.t[i]);
    for (std::size_t c = 0; c < shown; ++c) row.emplace_back(result.series.values[i][c]);
  }
  fmt::print("{}", output::to_text(table));
  if (shown < result.series.columns.size())
    fmt::print("{} more columns of the table are in {}\n", result.series.columns.size() - shown,
               folder.probes().string());
  if (estimate)
    fmt::print("{}{}", budget_words(result.summary["estimate"], result.end),
               estimate_words(result.estimate, result.summary["estimate"].contains("total")));
  for (const std::string& warning : result.warnings) fmt::print("Note: {}\n", warning);
  fmt::print("Results: {}\n", folder.path.string());
}

}  // namespace floe::app
