#pragma once
#include <petscts.h>

#include <vector>

#include "floe/dynamics/event.h"

namespace floe::dynamics {

/// Finds within a step where events happen whose time is not known before: the step is taken back and again, to there.
class Crossings {
 public:
  /// @param happened  of each event; both outlive this
  Crossings(const std::vector<Event>& events, const std::vector<double>& happened);
  /// Where a motion, or a part of it, begins. Collective.
  void begin(TS ts);
  /// After a step that stands: takes it back if an event is within it; at its end, when it was taken again, the solve
  /// ends (TS_CONVERGED_USER). Collective.
  void after_step(TS ts);
  /// Whether the step that was taken last was taken back.
  bool going_back() const { return back_; }
  /// Whether the motion is where an event happens that has not been dealt with.
  bool arrived() const { return arrived_; }
  /// Whether this event is where the motion is now.
  bool located(std::size_t event) const { return arrived_ && searched_ == static_cast<int>(event); }

 private:
  double value(std::size_t event, double t, Vec U, Vec V) const { return events_[event].crosses(t, U, V); }
  double locate(TS ts, std::size_t event, double before, double after) const;
  const std::vector<Event>& events_;
  const std::vector<double>& happened_;
  std::vector<double> value_;  // at the end of the last step
  int searched_ = -1;          // the event that a step is taken again for
  double target_ = 0;          // where it shall end [s]
  bool back_ = false, arrived_ = false;
};

}  // namespace floe::dynamics
