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
  if (!estimate) plan.newton_tolerance = newton_tolerance_;  // an estimate's residuals need accelerations
  assembly::Model model = candidates_.model(selection, estimate);
  ++count_;
  return move(with_step(step), model, 0, comm_, std::nullopt, plan);
}

void Trials::compare(Trial& trial, double step) const {
  if (!trial.failed.empty() || reference_.t.empty()) return;
  trial.error = Trial::none;
  if (std::abs(trial.series.t.back() - reference_.t.back()) > 2 * step)
    trial.failed = fmt::format("ends at t = {:.4g} s", trial.series.t.back());
  else
    trial.error = worst_error(trial.series, reference_);
  if (!std::isfinite(trial.error)) trial.error = Trial::none;
}

void Trials::compare_with(Series reference) {
  reference_ = std::move(reference);
  std::erase_if(known_, [](const auto& one) { return one.second.failed.empty() && one.second.series.t.empty(); });
  for (auto& [key, trial] : known_) compare(trial, std::get<2>(key));
}

const Trial& Trials::tried(const Selection& selection, double step) {
  constexpr std::size_t most_numbers = 20000000;  // 160 MB
  const auto key = std::tuple{selection.taken, selection.linear, step};
  const auto found = known_.find(key);
  if (found != known_.end()) return found->second;
  Trial trial;
  try {
    RunResult result = moved(selection, step, false, false);
    trial.seconds = result.motion_seconds;
    MPI_Bcast(&trial.seconds, 1, MPI_DOUBLE, 0, comm_);
    trial.series = std::move(result.series);
    compare(trial, step);
  } catch (const InputError& error) {
    trial.failed = shortened(error.what());
  } catch (const RunError& error) {
    if (Interruption::happened(comm_)) throw;
    trial.failed = shortened(error.what());
  }
  const std::size_t numbers = trial.series.t.size() * (1 + trial.series.columns.size());
  if (numbers_ + numbers > most_numbers)
    trial.series = {};
  else
    numbers_ += numbers;
  return known_.emplace(key, std::move(trial)).first->second;
}

Series Trials::series_of(const Selection& selection, double step) {
  const Trial& trial = tried(selection, step);
  return trial.series.t.empty() ? moved(selection, step, false, false).series : trial.series;
}

double Trials::error_of(const scene::Scene& scene, double step) {
  RunPlan plan;
  plan.quiet = true, plan.check_range = false;
  plan.energies = plan.balance = false;
  plan.newton_tolerance = newton_tolerance_;
  ++count_;
  const RunResult result = run(scene, scene::Formulation::vm_md, comm_, std::nullopt, plan);
  const double error = worst_error(result.series, reference_);
  return std::abs(result.end - reference_.t.back()) > 2 * step || !std::isfinite(error) ? Trial::none : error;
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

namespace {

/// How many leave out so little energy that its square root is the error.
std::size_t guessed(const std::vector<assess::EnergyContribution>& order, double error) {
  double left = 1;
  std::size_t count = 0;
  while (count < order.size() && left > error * error) left -= order[count++].share;
  return count;
}

}  // namespace

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
    std::size_t count = static_cast<std::size_t>((static_cast<long>(enough) + too_few) / 2);
    if (enough == most) {  // large models are expensive: not far beyond what was too few
      const auto few = static_cast<std::size_t>(too_few + 1);
      count = std::min(count, too_few < 0 ? guessed(order, error) : few + few / 2);
    }
    if (tried(first(count), step).error <= error)
      enough = count;
    else
      too_few = static_cast<long>(count);
  }
  return enough;
}

}  // namespace floe::app
