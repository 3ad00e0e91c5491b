#include "floe/assess/estimate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "estimate_parts.h"
#include "floe/assembly/body_stage.h"
#include "floe/assembly/enrichment.h"
#include "floe/assembly/lift.h"
#include "floe/assembly/residual_loads.h"
#include "floe/assembly/start_vectors.h"

namespace floe::assess {

using Eigen::VectorXd;
using petsc::check;
using solve::State;

namespace {

constexpr int max_samples = 16, min_samples = 4;  // of the full-order residual
constexpr int max_columns = 8, min_columns = 3;   // for each body
constexpr int most_tangents = 2;

bool keeps_factors(const Offline& offline) {
  for (std::size_t b = 0; b < offline.reduced.size(); ++b)
    if (has_structure(offline.plan.bodies[b]) && !offline.reduced[b].statics) return false;
  return true;
}

/// Where the motion deforms most, and some instants along it.
void sample(const Model& model, const KeptMotion& motion, const TimeBudget& time, Residuals& residuals,
            Estimate& estimate) {
  const std::vector<State> states = spread(motion.states(), max_samples - 1);
  const State& greatest = most_deformed(model, motion.states());
  std::size_t count = std::min<std::size_t>(states.size(), min_samples);
  std::vector<State> all{greatest};
  if (!residuals.apart()) {
    const double before = time.spent();
    residuals.add(all);
    all.clear();
    const double each = time.spent() - before;
    count = std::min<std::size_t>(
        states.size(), static_cast<std::size_t>(std::max(1.0 * min_samples, 0.3 * time.left() / std::max(each, 1e-9))));
  }
  for (const State& state : spread(states, count))
    if (state.t != greatest.t) all.push_back(state);
  residuals.add(all);
  estimate.samples = residuals.samples, estimate.unbalanced = residuals.unbalanced();
  if (count < states.size())
    estimate.notes.push_back(fmt::format("{} residuals instead of {}, to save time", count, states.size()));
}

/// Columns that the time allows: projecting k + s of them costs about ((k + s)/k)^4 of what it cost for k.
int columns_in(double seconds, const ReducedBody& reduced) {
  const double k = std::max(1, reduced.body.coordinates());
  const double factor = std::pow(seconds / std::max(reduced.report.seconds_projection, 1e-6), 0.25);
  return std::clamp(static_cast<int>(k * (factor - 1)), min_columns, max_columns);
}

std::vector<ReducedBody> enriched(const Offline& offline, const Residuals& residuals, const TimeBudget& time,
                                  Estimate& estimate) {
  std::vector<ReducedBody> bodies;
  note_files(offline, estimate);
  const double all = static_cast<double>(offline.reduced.size());
  for (std::size_t b = 0; b < offline.reduced.size(); ++b) {
    const PlannedBody& body = offline.plan.bodies[b];
    const ReducedBody& reduced = offline.reduced[b];
    bodies.push_back(reduced);
    estimate.responses.emplace_back();
    if (!has_structure(body)) continue;
    const int most =
        static_cast<int>(time.of_first(columns_in(0.5 * time.left() / (all - static_cast<double>(b)), reduced)));
    if (most < max_columns)
      estimate.notes.push_back(
          fmt::format("body {}: {} basis vectors instead of {}, to save time", body.spec.name, most, max_columns));
    const int tangents = reduced.relief.W ? 0 : time.half_left() ? most_tangents : 1;
    const auto W = std::make_shared<const reduction::Columns>(
        main_columns(body.structure, responses(body, reduced, residuals.loads(b), tangents, estimate.notes), most));
    if (W->empty()) continue;
    estimate.responses.back() = W;
    bodies.back() = with_columns(body, reduced, *W);
    relieve(body, residuals.loads(b), *W, reduced, bodies.back());
    condense(body, bodies.back());
    estimate.columns += bodies.back().body.coordinates() - reduced.body.coordinates();
  }
  return bodies;
}

/// The deviation at the start. A motion that begins deformed, in an equilibrium or in a steady rotation begins in that
/// of its model: from the reduced one the enriched model would vibrate, which the full-order model does not.
solve::DeviationStart at_start(const Offline& offline, const Model& more) {
  bool deformed = false;
  for (const PlannedBody& body : offline.plan.bodies) deformed |= starts_deformed(body);
  if (offline.plan.scene.motion.start == Motion::Start::given && !deformed) return {};
  const Model reduced = assemble(offline.plan, Formulation::vm_md, offline.reduced);
  const auto start_of = [](const Model& model) {
    const petsc::VecHandle none = model.system->create_vector();
    return solve::state_of(*model.system, 0, model.U, model.V, none);
  };
  return solve::deviation_between(*more.system, lifted_to_more_columns(start_of(reduced), reduced, more),
                                  start_of(more));
}

/// Of the reduced model itself, by their times: at its states the enriched model, whose energies are condensed over
/// other displacements, has other forces of supports.
std::map<double, std::vector<double>> values_of(const Model& reduced, const KeptMotion& motion) {
  const dynamics::System& system = *reduced.system;
  const petsc::VecHandle U = system.create_vector(), V = system.create_vector(), A = system.create_vector();
  std::map<double, std::vector<double>> values;
  for (const State& state : motion.states()) {
    solve::set_state(system, state, U, V, A);
    values[state.t] = probe_values(reduced, state.t, U, V, A);
  }
  return values;
}

/// Follows the deviation, on every rank alike.
void follow(const Model& reduced, const Model& more, const KeptMotion& motion, const TimeBudget& time,
            Estimate& estimate) {
  const dynamics::System& system = *more.system;
  const solve::DeviationStart start = at_start(*reduced.offline, more);
  if (start.d.size() > 0) estimate.deviation_at_start = deformations(more, start.d);
  std::vector<State> states;
  const petsc::VecHandle U = system.create_vector(), V = system.create_vector(), A = system.create_vector();
  for (const State& state : motion.states()) {  // one after another, as joints count their turns
    State& lifted = states.emplace_back(lifted_to_more_columns(state, reduced, more));
    solve::set_state(system, lifted, U, V, A);
    system.rebase(U, V, lifted.t);
    system.save(lifted.carried);
  }
  const auto values = [&](const State& state) {
    solve::set_state(system, state, U, V, A);
    return probe_values(more, state.t, U, V, A);
  };
  const double before = time.spent();  // of some steps, to know how many there may be
  const std::vector<State> first(states.begin(), states.begin() + std::min<std::ptrdiff_t>(8, std::ssize(states)));
  solve::deviation(
      system, motion.begin(), first,
      [&](const State& state, const VectorXd&, const VectorXd&, const VectorXd&) { values(state), values(state); },
      start);
  const double each = (time.spent() - before) / static_cast<double>(first.size());
  const double most = std::max(time.left(), 0.2 * time.spent());  // few steps save little of what is spent already
  const auto count = static_cast<std::size_t>(time.of_first(std::max(50.0, most / std::max(each, 1e-9))));
  if (count < states.size()) {
    estimate.notes.push_back(fmt::format("{} steps instead of {}, to save time", count, states.size()));
    states = spread(states, count);
  }
  const std::map<double, std::vector<double>> own = values_of(reduced, motion);
  ProbeErrors probes(probe_columns(more));
  double error = 0, size = 0;
  const auto observe = [&](const State& state, const VectorXd& d, const VectorXd& rate, const VectorXd& second_rate) {
    const std::vector<double>& was = own.at(state.t);
    std::vector<double> gap = values(solve::deviated(system, state, d, rate, second_rate));
    for (std::size_t i = 0; i < gap.size(); ++i) gap[i] -= was[i];
    probes.add(gap, was);
    estimate.deviations.push_back(deformations(more, d));
    const double e = estimate.deviations.back().squaredNorm();
    error += e, size += deformations(more, state.q).squaredNorm();
    estimate.t.push_back(state.t);
    estimate.errors.push_back(std::move(gap));
    estimate.relative.push_back(std::sqrt(e));
  };
  const solve::DeviationReport report = solve::deviation(system, motion.begin(), states, observe, start);
  if (report.steps == 0) throw RunError("the equations of the error cannot be integrated from the start");
  if (report.steps < std::ssize(states))
    estimate.notes.push_back(fmt::format("the equations of the error diverge at t = {:.6g} s", report.end));
  const auto steps = static_cast<double>(report.steps);
  estimate.probes = known(probes.relative(estimate.t.back() - motion.begin()));
  const bool nothing = std::max(error, size) <= steps * round_off_of(*reduced.offline);
  for (double& e : estimate.relative) e = nothing || e == 0 ? 0 : e / std::sqrt(size / steps);
  estimate.deformation = nothing ? 0 : known(std::sqrt(error / size));
}

void make(const Model& model, const KeptMotion& motion, const TimeBudget& time, Estimate& estimate) {
  Offline& offline = *model.offline;
  Residuals residuals(model, offline);
  sample(model, motion, time, residuals, estimate);
  const std::vector<ReducedBody> bodies = enriched(offline, residuals, time, estimate);
  for (const ReducedBody& body : bodies) estimate.bases.push_back(body.basis);
  const Model more = assemble(offline.plan, Formulation::vm_md, bodies);
  follow(model, more, motion, time, estimate);
}

}  // namespace

Estimate estimate_error(const Model& model, const KeptMotion& motion, double seconds) {
  Estimate estimate;
  estimate.none.clear();
  if (!model.offline || !is_reduced(model.formulation)) {
    estimate.none = "it applies to reduced models only (vm, vm+md)";
    return estimate;
  }
  const Offline& offline = *model.offline;
  const TimeBudget time(offline.plan.comm, seconds);
  estimate.none = without_estimate(offline);
  if (!estimate.none.empty()) return estimate;
  if (!keeps_factors(offline))
    estimate.none = "the factors of the stiffness were not kept";
  else if (motion.states().empty())
    estimate.none = "the integrator provides no accelerations";
  if (!estimate.none.empty()) return estimate;
  fill_in(estimate, offline.plan.comm, time, seconds, [&] { make(model, motion, time, estimate); });
  return estimate;
}

}  // namespace floe::assess
