#include "floe/assess/budget.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "floe/assess/probe_errors.h"

namespace floe::assess {

namespace {

constexpr std::size_t most_instants = 1000;  // where there is no estimate of the reduction

/// Known to the end of the motion, or so far that the rest does not count.
bool whole(const ErrorPart& part, const ProbeSeries& own) {
  return !part.t.empty() && part.t.back() >= own.t.front() + 0.98 * (own.t.back() - own.t.front());
}

}  // namespace

Estimate of_whole(Estimate reduction, const KeptMotion& motion) {
  const std::vector<solve::State>& states = motion.states();
  if (reduction.t.empty() || !reduction.by.empty() || states.empty()) return reduction;
  const double begin = states.front().t, end = states.back().t;
  if (reduction.t.back() >= begin + 0.98 * (end - begin)) return reduction;
  Estimate none;
  none.none =
      fmt::format("it ends at t = {:.4g} s of {:.4g} s: {}", reduction.t.back(), end, fmt::join(reduction.notes, "; "));
  none.seconds = reduction.seconds, none.allowed = reduction.allowed;
  return none;
}

ProbeSeries probe_series(const Model& model, const KeptMotion& motion, const Estimate& reduction) {
  ProbeSeries series{probe_columns(model), {}, {}, motion.changes(), motion.event_error(), motion.impulsive()};
  const std::vector<solve::State>& states = motion.states();
  const petsc::VecHandle U = model.system->create_vector(), V = model.system->create_vector(),
                         A = model.system->create_vector();
  const std::size_t stride = reduction.t.empty() ? 1 + states.size() / most_instants : 1;
  for (std::size_t i = states.empty() ? 0 : (states.size() - 1) % stride; i < states.size(); i += stride) {
    if (!reduction.t.empty() && !std::binary_search(reduction.t.begin(), reduction.t.end(), states[i].t)) continue;
    solve::set_state(*model.system, states[i], U, V, A);
    series.t.push_back(states[i].t);
    series.values.push_back(probe_values(model, states[i].t, U, V, A));
  }
  return series;
}

std::vector<double> total_error(const ProbeSeries& own, const std::vector<const ErrorPart*>& parts,
                                const std::vector<const ErrorPart*>& beside) {
  if (own.t.empty()) return {};
  std::vector<std::vector<double>> sum(own.t.size(), std::vector<double>(own.columns.size(), 0));
  for (const ErrorPart* part : parts) {
    if (!whole(*part, own)) continue;
    for (std::size_t i = 0; i < own.t.size(); ++i) {
      const auto at = std::lower_bound(part->t.begin(), part->t.end(), own.t[i]);
      if (at == part->t.end() || *at != own.t[i]) continue;
      const std::vector<double>& error = part->errors[static_cast<std::size_t>(at - part->t.begin())];
      for (std::size_t c = 0; c < error.size(); ++c)
        if (!std::isnan(error[c])) sum[i][c] += error[c];
    }
  }
  ProbeErrors errors(own.columns);
  for (std::size_t i = 0; i < own.t.size(); ++i) errors.add(sum[i], own.values[i]);
  std::vector<double> total = errors.relative(own.t.back() - own.t.front());
  for (const ErrorPart* part : parts)
    for (std::size_t p = 0; p < part->probes.size(); ++p)
      if (!whole(*part, own) && !std::isnan(part->probes[p])) total[p] += part->probes[p];
  for (const ErrorPart* part : beside)
    for (std::size_t p = 0; p < part->probes.size(); ++p)
      if (!std::isnan(part->probes[p])) total[p] = std::hypot(total[p], part->probes[p]);
  for (double& error : total)
    if (error > 100) error = std::numeric_limits<double>::infinity();
  return total;
}

}  // namespace floe::assess
