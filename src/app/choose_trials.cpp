#include "choose_trials.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compare_table.h"
#include "interruption.h"

namespace floe::app {

std::string shortened(const std::string& text) {
  const std::string line = text.substr(0, text.find('\n'));
  return line.size() > 90 ? line.substr(0, 87) + "..." : line;
}

scene::Scene Trials::with_step(double step) const {
  scene::Scene other = scene_;
  other.motion.step = step, other.motion.every = 1, other.motion.tolerance.reset();
  other.motion.output = scene_.motion.output.value_or(scene_.motion.step * scene_.motion.every);
  return other;
}

RunResult Trials::moved(const Selection& selection, double step, bool estimate, bool keep_states) {
  RunPlan plan;
  plan.quiet = true, plan.check_range = false;
  plan.energies = plan.balance = false;
  plan.estimate = estimate, plan.budget = false, plan.keep_states = keep_states;
  plan.estimate_seconds = 1e9;
  assembly::Model model = candidates_.model(selection, estimate);
  ++count_;
  return move(with_step(step), model, 0, comm_, std::nullopt, plan);
}

Trial Trials::tried(const Selection& selection, double step) {
  const auto key = std::tuple{selection.taken, selection.linear, step};
  const auto found = known_.find(key);
  if (found != known_.end()) return found->second;
  Trial trial;
  try {
    const RunResult result = moved(selection, step, false, false);
    trial.seconds = result.motion_seconds;
    MPI_Bcast(&trial.seconds, 1, MPI_DOUBLE, 0, comm_);
    if (std::abs(result.end - reference.t.back()) > 2 * step)
      trial.failed = fmt::format("ends at t = {:.4g} s", result.end);
    else
      trial.error = worst_error(result.series, reference);
  } catch (const InputError& error) {
    trial.failed = shortened(error.what());
  } catch (const RunError& error) {
    if (Interruption::happened(comm_)) throw;
    trial.failed = shortened(error.what());
  }
  if (!std::isfinite(trial.error)) trial.error = Trial::none;
  known_.emplace(key, trial);
  return trial;
}

double Trials::error_of(const scene::Scene& scene, double step) {
  RunPlan plan;
  plan.quiet = true, plan.check_range = false;
  plan.energies = plan.balance = false;
  ++count_;
  const RunResult result = run(scene, scene::Formulation::vm_md, comm_, std::nullopt, plan);
  const double error = worst_error(result.series, reference);
  return std::abs(result.end - reference.t.back()) > 2 * step || !std::isfinite(error) ? Trial::none : error;
}

double Trials::seconds_of(const Selection& selection, double step) {
  double least = tried(selection, step).seconds;
  for (int again = 1; again < 5 && least < 0.05; ++again) {
    double seconds = moved(selection, step, false, false).motion_seconds;
    MPI_Bcast(&seconds, 1, MPI_DOUBLE, 0, comm_);
    least = std::min(least, seconds);
  }
  return least;
}

Trials::Selection Trials::first_of(const std::vector<assess::EnergyContribution>& order, std::size_t count) const {
  Selection selection{std::vector<char>(candidates_.columns().size(), 0), false};
  for (std::size_t i = 0; i < count; ++i) selection.taken[order[i].column] = 1;
  return selection;
}

std::size_t Trials::fewest(const std::vector<assess::EnergyContribution>& order, std::size_t most, double step,
                           double error, bool linear) {
  const auto first = [&](std::size_t count) {
    Selection selection = first_of(order, count);
    selection.linear = linear;
    return selection;
  };
  std::size_t enough = most;
  long too_few = -1;
  for (std::size_t count = 0; count < enough; ++count) {
    const auto found = known_.find(std::tuple{first(count).taken, linear, step});
    if (found == known_.end()) continue;
    if (found->second.error <= error)
      enough = count;
    else
      too_few = static_cast<long>(count);
  }
  while (static_cast<long>(enough) - too_few > 1) {
    const std::size_t middle = static_cast<std::size_t>((static_cast<long>(enough) + too_few) / 2);
    if (tried(first(middle), step).error <= error)
      enough = middle;
    else
      too_few = static_cast<long>(middle);
  }
  return enough;
}

}  // namespace floe::app
