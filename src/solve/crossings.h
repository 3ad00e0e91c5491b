#pragma once
#include <petscts.h>

#include <optional>
#include <vector>

#include "floe/dynamics/event.h"

namespace floe::solve {
using namespace dynamics;

/// Finds within a step where events happen whose time is not known before: the step is taken back and again, to there.
///
/// Events that repeat are reported here, and the motion goes on: nothing changes at them. Such an event is on one side
/// of its zero, +1 or -1, and happens where it comes to the other. A step may also begin and end on one side and visit
/// the other between: that is seen by rates at both ends, or where there are none by values within the step.
class Crossings {
 public:
  /// @param happened  of each event whether it has; of one that repeats its side, 0: not known
  /// @param step      that fixed steps go on with after an event; 0: steps are adaptive
  /// @param on_event  called where an event that repeats happens. All outlive this.
  Crossings(const std::vector<Event>& events, std::vector<double>& happened, double step,
            const std::function<void(const EventReport&)>& on_event);
  /// Where a motion, or a part of it, begins. Collective.
  void begin(TS ts);
  /// After a step that stands: takes it back if an event is within it; at its end, when it was taken again, the solve
  /// ends (TS_CONVERGED_USER) unless the event is one that repeats. Collective.
  void after_step(TS ts);
  /// Whether the step that was taken last was taken back.
  bool going_back() const { return back_; }
  /// Whether the motion is where an event happens that has not been dealt with.
  bool arrived() const { return arrived_; }
  /// Whether this event is where the motion is now: several may be at one instant.
  bool located(std::size_t event) const { return arrived_ && located_[event] != 0; }

 private:
  /// A step: its ends, and what is searched between.
  struct Step {
    TS ts;
    double begin, end;
    Vec U, V;  // at the end
  };
  /// Values and rates of the events at an instant.
  struct Seen {
    std::vector<double> value, rate;
  };
  Seen see(double t, Vec U, Vec V) const;
  double within(const Step& step, std::size_t event, double t) const;
  double locate(const Step& step, std::size_t event, double low, double high, double before, double after) const;
  std::optional<double> visit(const Step& step, std::size_t event, const Seen& now) const;
  std::optional<double> crossing(const Step& step, std::size_t event, const Seen& now) const;
  std::optional<double> change_of_side(const Step& step, std::size_t event, const Seen& now) const;
  void after_step_again(const Step& step);
  double find_first(const Step& step, const Seen& now);
  void mark_located(const Seen& now);
  void report(std::size_t event, double t, double rate);
  void go_on(const Step& step);
  void shorten(TS ts, const Seen& now) const;
  bool passes_over(double h, const Seen& now) const;
  void take_back(TS ts, double h);
  const std::vector<Event>& events_;
  std::vector<double>& happened_;
  double step_;
  const std::function<void(const EventReport&)>& on_event_;
  Seen before_;                // at the end of the last step
  int searched_ = -1;          // the event that a step is taken again for
  std::vector<char> located_;  // of each event: it is at the same instant
  double target_ = 0;          // where it shall end [s]
  double whole_ = 0;           // how long it was before it was taken back [s]
  bool back_ = false, arrived_ = false;
};

}  // namespace floe::solve
