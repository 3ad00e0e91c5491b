#pragma once
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "floe/assembly/kept_motion.h"
#include "floe/assembly/model.h"
#include "floe/solve/simulation.h"

namespace floe::assess {
using namespace assembly;

/// Visits given instants of a motion, between its steps by interpolation.
class AtTimes {
 public:
  /// @param times  ascending [s]
  AtTimes(const Model& model, std::vector<double> times, double step);

  /// @param visit  (number of the instant, t, U, V, A; A null where it is not known)
  template <class Visit>
  void observe(const solve::Instant& instant, Visit&& visit) {
    for (; next_ < times_.size() && times_[next_] < instant.t + tolerance_; ++next_) {
      const double t = times_[next_];
      if (t > instant.t - tolerance_) {
        visit(next_, t, instant.U, instant.V, instant.accelerations());
      } else if (instant.between) {
        (*instant.between)(t, U_, V_, A_);
        visit(next_, t, U_.get(), V_.get(), A_.get());
      }
    }
  }

 private:
  std::vector<double> times_;
  double tolerance_;
  petsc::VecHandle U_, V_, A_;
  std::size_t next_ = 0;
};

/// Whether the events that have changed joints before an instant t of a motion are those that `happened` in another
/// one.
bool same_joints(const std::vector<JointChange>& changes, double t, std::span<const std::string> happened);

/// Probes of a motion at given instants.
struct ProbeHistory {
  std::vector<std::vector<double>> values;  ///< of each instant that was reached, each column of the model
  double reached = 0;                       ///< [s]
  double event_error = 0;  ///< as KeptMotion::event_error; infinite: it stopped behind an event that changed joints
  std::vector<std::string> changes = {};   ///< events that have changed joints, in their order
  std::vector<std::size_t> happened = {};  ///< how many of them had, of each instant of `values`
  bool enough = false;                     ///< it was ended by `enough`
  std::string stopped;                     ///< why it stopped before its end; empty: it did not
};

/// Simulates a scene's model from its vectors U, V.
/// @param how     end, step, scheme; events and kinks are those of the scene
/// @param enough  called after each step, ends the motion where true; the same on all ranks of the system
/// Collective where the system is.
ProbeHistory probe_history(const Scene& scene, const Model& model, solve::Integration how,
                           const std::vector<double>& times,
                           const std::function<bool(const solve::Instant&)>& enough = {});

/// The same of equilibria from t = 0 on, `how.step` apart. @throws InputError; what else fails ends them (`stopped`)
ProbeHistory equilibrium_history(const Model& model, const solve::Integration& how, const std::vector<double>& times,
                                 const std::function<bool(const solve::Instant&)>& enough = {});

}  // namespace floe::assess
