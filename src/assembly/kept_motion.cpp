#include "floe/assembly/kept_motion.h"

#include <algorithm>

namespace floe::assembly {

using Eigen::VectorXd;
using solve::State;

void KeptMotion::keep(const solve::Instant& instant) {
  if (instant.step == 0) begin_ = instant.t;
  if (!changes_.empty() || impulsive_) event_error_ = std::max(event_error_, instant.event_error);
  const bool again = !changes_.empty() && instant.t == changes_.back().t;  // behind the event
  if (again || !instant.A || (instant.step % stride_ != 0 && !instant.last)) return;
  states_.push_back(solve::state_of(*model_.system, instant.t, instant.U, instant.V, instant.A));
  if (states_.size() < most_) return;
  for (std::size_t i = 0; 2 * i + 1 < states_.size(); ++i) std::swap(states_[i], states_[2 * i + 1]);
  states_.resize(states_.size() / 2);
  stride_ *= 2;
}

void KeptMotion::note(const solve::EventReport& event) {
  impulsive_ = impulsive_ || event.work;
  if (event.switches) changes_.push_back({event.name, event.t});
}

VectorXd deformations(const Model& model, const VectorXd& q) {
  std::vector<double> all;
  for (const BodyReport& body : model.bodies)
    all.insert(all.end(), q.data() + body.first_elastic, q.data() + body.first_elastic + body.columns);
  return Eigen::Map<VectorXd>(all.data(), static_cast<Eigen::Index>(all.size()));
}

const State& most_deformed(const Model& model, const std::vector<State>& states) {
  return *std::max_element(states.begin(), states.end(), [&](const State& a, const State& b) {
    return deformations(model, a.q).squaredNorm() < deformations(model, b.q).squaredNorm();
  });
}

}  // namespace floe::assembly
