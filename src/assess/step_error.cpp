#include "floe/assess/step_error.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "estimate_parts.h"
#include "floe/assess/probe_errors.h"
#include "floe/solve/generalized_alpha.h"

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

/// Compares a motion with kept states of another one, at their times.
class Comparison {
 public:
  Comparison(const Model& model, const KeptMotion& motion, double step)
      : model_(model),
        states_(motion.states()),
        tolerance_(1e-6 * step),
        probes_(probe_columns(model)),
        U_(model.system->create_vector()),
        V_(model.system->create_vector()),
        A_(model.system->create_vector()) {
    for (const State& state : states_) {
      solve::set_state(*model.system, state, U_, V_, A_);
      values_.push_back(probe_values(model, state.t, U_, V_));
    }
  }

  void observe(const solve::Instant& instant) {
    for (; next_ < states_.size() && states_[next_].t < instant.t + tolerance_; ++next_) {
      const double t = states_[next_].t;
      if (t > instant.t - tolerance_) {
        add(t, instant.U, instant.V);
      } else if (instant.between) {
        (*instant.between)(t, U_, V_);
        add(t, U_, V_);
      }
    }
  }

  int count() const { return count_; }
  std::vector<double> probes(double duration) const { return probes_.relative(duration); }
  double deformation() const {
    const double nothing = model_.offline ? count_ * round_off_of(*model_.offline) : 0;
    return std::max(error_, size_) > nothing ? std::sqrt(error_ / size_) : 0;
  }

 private:
  void add(double t, Vec U, Vec V) {
    const std::vector<double>& mine = values_[next_];
    std::vector<double> gap = probe_values(model_, t, U, V);
    for (std::size_t i = 0; i < gap.size(); ++i) gap[i] -= mine[i];
    probes_.add(gap, mine);
    VectorXd q;
    model_.system->gather(U, q);
    error_ += (elastic(model_, q) - elastic(model_, states_[next_].q)).squaredNorm();
    size_ += elastic(model_, states_[next_].q).squaredNorm();
    ++count_;
  }

  const Model& model_;
  const std::vector<State>& states_;
  double tolerance_;
  ProbeErrors probes_;
  petsc::VecHandle U_, V_, A_;
  std::vector<std::vector<double>> values_;
  std::size_t next_ = 0;
  int count_ = 0;
  double error_ = 0, size_ = 0;
};

}  // namespace

MotionStart start_of(const Model& model) {
  MotionStart start{solve::state_of(*model.system, 0, model.U, model.V, model.V), {}};
  model.system->save(start.carried);
  return start;
}

StepError estimate_step_error(const Model& model, const MotionStart& start, const KeptMotion& motion,
                              solve::Integration how, double took, double allowed) {
  StepError error;
  error.none.clear();
  if (how.tolerance) error.none = "steps are adaptive, controlled by motion.tolerance";
  if (motion.states().empty()) error.none = "the integrator provides no accelerations";
  if (!error.none.empty()) return error;
  const double begin = MPI_Wtime();
  error.halved = refinement * took <= allowed;
  error.until = motion.states().back().t;
  if (!error.halved) error.until *= std::min(1.0, allowed * refinement / std::max(took, 1e-12));
  const double step = how.step;
  how.step = error.halved ? step / refinement : step * refinement;
  how.end = error.until;
  how.on_event = [](const dynamics::EventReport&) {};
  Comparison comparison(model, motion, step);
  const petsc::VecHandle A = model.system->create_vector();
  solve::set_state(*model.system, start.state, model.U, model.V, A);
  model.system->load(start.carried);
  const solve::IntegrationReport report = solve::simulate(
      *model.system, how, model.U, model.V, [&](const solve::Instant& instant) { comparison.observe(instant); });
  const double steps = error.until / how.step;
  if (report.type != solve::generalized_alpha || comparison.count() == 0)
    error.none = "the integrator does not interpolate within steps";
  else if (static_cast<double>(report.steps) < 0.75 * steps || static_cast<double>(report.steps) > 1.5 * steps + 2)
    error.none = "options set the step";
  const double power = std::pow(refinement, order);
  const double share = error.halved ? power / (power - 1) : 1 / (power - 1);
  for (const double e : comparison.probes(error.until)) error.probes.push_back(known(share * e));
  error.deformation = known(share * comparison.deformation());
  error.seconds = MPI_Wtime() - begin;
  return error;
}

}  // namespace floe::assess
