#pragma once
#include <functional>
#include <memory>
#include <vector>

#include "crossings.h"
#include "floe/petsc/error.h"
#include "floe/petsc/handle.h"
#include "floe/solve/simulation.h"

namespace floe::solve {

/// What the callbacks of a motion's TS share.
struct MotionContext {
  const System& system;
  const std::function<void(const Instant&)>& observe;
  const std::vector<Event>& events;
  const std::vector<Kink>& kinks;
  double end = 0;  ///< [s]
  bool adaptive = false;
  double nominal = 0;  ///< the fixed step [s]
  petsc::Guard guard = {};
  TS ts = nullptr;
  std::vector<double> carried_of_tangent = {};        ///< as it was when the last tangent was formed
  std::vector<Eigen::Matrix3d> axes_of_tangent = {};  ///< of frames, likewise
  std::function<MotionState()> state = {};
  std::function<void(double, Vec, Vec, Vec)> between = {};
  std::unique_ptr<Crossings> crossings = {};
  std::vector<double> happened = {};    ///< of each event
  bool observed = false;                ///< the instant that TS begins with, before a kink
  petsc::VecHandle accelerations = {};  ///< of the start, until the integrator takes them over
};

/// Whether an event is due at t, which the motion has reached.
inline bool is_due(const MotionContext& context, std::size_t i, double t) {
  const Event& event = context.events[i];
  return event.watched() ? context.crossings->located(i) : event.at <= t + 1e-12 * context.end;
}

/// Gives a TS its callbacks, type, times and solvers, and the options of the command line. F, J: of the system's
/// layout.
/// @throws InputError  an option that no motion can have. Collective.
void set_up_motion(TS ts, const System& system, const Integration& how, MotionContext& context, Vec U, Vec V, Vec F,
                   Mat J);

/// The function after each step of a motion with events: sends TS back to a crossing within it. Collective.
PetscErrorCode post_step(TS ts);

}  // namespace floe::solve
