#pragma once
#include "floe/assembly/model.h"
#include "floe/solve/deviation.h"
#include "floe/solve/simulation.h"

namespace floe::assembly {

/// An event that has locked or unlocked a joint.
struct JointChange {
  std::string event;
  double t = 0;  ///< [s]; the state at t is that before it
};

/// States of a reduced motion, each so many steps apart that there are at most `most`: what its estimate needs.
class KeptMotion {
 public:
  explicit KeptMotion(const Model& model, std::size_t most = 4000) : model_(model), most_(most) {}
  /// Called at the start and after each step; the start has no accelerations yet and only gives the time.
  void keep(const solve::Instant& instant);
  /// Called after each event.
  void note(const solve::EventReport& event);
  double begin() const { return begin_; }
  const std::vector<JointChange>& changes() const { return changes_; }
  /// The largest one of steps after these and after impulses (solve::Instant).
  double event_error() const { return event_error_; }
  /// Whether impulses have changed the velocities: at the start, to fit joints and drives, or where speeds of drives
  /// jump. Other models respond to them with other velocities, which residuals at states do not show.
  bool impulsive() const { return impulsive_ || model_.velocity_correction > 1e-3; }
  const std::vector<solve::State>& states() const { return states_; }

 private:
  const Model& model_;
  std::size_t most_;
  double begin_ = 0;
  PetscInt stride_ = 1;
  std::vector<solve::State> states_;
  std::vector<JointChange> changes_;
  bool impulsive_ = false;
  double event_error_ = 0;
};

/// Every so many of them, `count` in all, the last one among them.
template <class Value>
std::vector<Value> spread(const std::vector<Value>& all, std::size_t count) {
  if (count >= all.size()) return all;
  std::vector<Value> some;
  for (std::size_t i = 1; i <= count; ++i) some.push_back(all[i * all.size() / count - 1]);
  return some;
}

/// The state whose elastic coordinates are the greatest.
const solve::State& most_deformed(const Model& model, const std::vector<solve::State>& states);
/// Elastic coordinates of all bodies.
Eigen::VectorXd deformations(const Model& model, const Eigen::VectorXd& q);

}  // namespace floe::assembly
