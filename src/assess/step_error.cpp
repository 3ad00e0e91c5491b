#include "floe/assess/step_error.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>

#include "estimate_parts.h"
#include "floe/assess/probe_errors.h"
#include "floe/solve/generalized_alpha.h"
#include "probe_history.h"

namespace floe::assess {

using Eigen::VectorXd;
using solve::State;

namespace {

constexpr double refinement = 2, order = 2;

/// Elastic coordinates of all bodies.
VectorXd elastic(const Model& model, const VectorXd& q) {
  std::vector<double> all;
  for (const BodyReport& body : model.bodies)
    all.insert(all.end(), q.data() + body.first_elastic, q.data() + body.first_elastic + body.columns);
  return Eigen::Map<VectorXd>(all.data(), static_cast<Eigen::Index>(all.size()));
}

std::vector<double> times_of(const std::vector<State>& states) {
  std::vector<double> times;
  for (const State& state : states) times.push_back(state.t);
  return times;
}

/// Compares a motion with kept states of another one, at their times.
class Comparison {
 public:
  Comparison(const Model& model, const KeptMotion& motion, double step)
      : model_(model),
        motion_(motion),
        states_(motion.states()),
        at_(model, times_of(states_), step),
        probes_(probe_columns(model)) {
    const petsc::VecHandle U = model.system->create_vector(), V = model.system->create_vector(),
                           A = model.system->create_vector();
    for (const State& state : states_) {
      solve::set_state(*model.system, state, U, V, A);
      values_.push_back(probe_values(model, state.t, U, V, A));
    }
  }

  void observe(const solve::Instant& instant) {
    at_.observe(instant, [&](std::size_t i, double t, Vec U, Vec V, Vec A) { add(i, t, U, V, A); });
  }

  void note(const dynamics::EventReport& event) {
    if (event.switches) changes_.push_back(event.name);
  }

  std::size_t count() const { return t_.size(); }
  double last() const { return t_.back(); }
  std::vector<double> probes(double duration) const { return probes_.relative(duration); }
  double deformation() const {
    const double nothing = model_.offline ? static_cast<double>(count()) * round_off_of(*model_.offline) : 0;
    return std::max(error_, size_) > nothing ? std::sqrt(error_ / size_) : 0;
  }
  /// Instants, and the differences of the probes, other less kept, times `weight`.
  void give(double weight, StepError& error) {
    error.t = std::move(t_), error.errors = std::move(gaps_);
    for (std::vector<double>& row : error.errors)
      for (double& one : row) one *= weight;
  }

 private:
  void add(std::size_t i, double t, Vec U, Vec V, Vec A) {
    if (!same_joints(motion_.changes(), states_[i].t, changes_)) return;
    const std::vector<double>& mine = values_[i];
    std::vector<double> gap = probe_values(model_, t, U, V, A);
    for (std::size_t c = 0; c < gap.size(); ++c) gap[c] -= mine[c];
    probes_.add(gap, mine);
    VectorXd q;
    model_.system->gather(U, q);
    error_ += (elastic(model_, q) - elastic(model_, states_[i].q)).squaredNorm();
    size_ += elastic(model_, states_[i].q).squaredNorm();
    t_.push_back(states_[i].t);
    gaps_.push_back(std::move(gap));
  }

  const Model& model_;
  const KeptMotion& motion_;
  const std::vector<State>& states_;
  std::vector<std::string> changes_;  // events
  AtTimes at_;
  ProbeErrors probes_;
  std::vector<std::vector<double>> values_;
  std::vector<double> t_;
  std::vector<std::vector<double>> gaps_;
  double error_ = 0, size_ = 0;
};

}  // namespace

State start_of(const Model& model) { return solve::state_of(*model.system, 0, model.U, model.V, model.V); }

StepError estimate_step_error(const Model& model, const State& start, const KeptMotion& motion, solve::Integration how,
                              double took, double allowed) {
  StepError error;
  error.none.clear();
  if (how.tolerance) error.none = "steps are adaptive, controlled by motion.tolerance";
  if (motion.states().empty()) error.none = "the integrator provides no accelerations";
  if (!error.none.empty()) return error;
  const std::clock_t begin = std::clock();
  error.halved = refinement * took <= allowed;
  error.until = motion.states().back().t;
  if (!error.halved) error.until *= std::min(1.0, allowed * refinement / std::max(took, 1e-12));
  const double step = how.step;
  how.step = error.halved ? step / refinement : step * refinement;
  how.end = error.until;
  Comparison comparison(model, motion, step);
  how.on_event = [&](const dynamics::EventReport& event) { comparison.note(event); };
  const petsc::VecHandle A = model.system->create_vector();
  solve::set_state(*model.system, start, model.U, model.V, A);
  const solve::IntegrationReport report = solve::simulate(
      *model.system, how, model.U, model.V, [&](const solve::Instant& instant) { comparison.observe(instant); });
  const double steps = error.until / how.step;
  if (report.type != solve::generalized_alpha || comparison.count() == 0)
    error.none = "the integrator does not interpolate within steps";
  else if (static_cast<double>(report.steps) < 0.75 * steps || static_cast<double>(report.steps) > 1.5 * steps + 2)
    error.none = "options set the step";
  if (comparison.count() > 0 && comparison.last() < 0.98 * error.until) error.until = comparison.last();
  const double power = std::pow(refinement, order);
  const double share = error.halved ? power / (power - 1) : 1 / (power - 1);
  for (const double e : comparison.probes(error.until)) error.probes.push_back(known(share * e));
  error.deformation = known(share * comparison.deformation());
  comparison.give(error.halved ? share : -share, error);
  error.seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  return error;
}

}  // namespace floe::assess
