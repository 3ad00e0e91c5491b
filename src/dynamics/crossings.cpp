#include "crossings.h"

#include <algorithm>
#include <cmath>

#include "floe/petsc/handle.h"

namespace floe::dynamics {

using petsc::check;

Crossings::Crossings(const std::vector<Event>& events, const std::vector<double>& happened)
    : events_(events), happened_(happened), value_(events.size(), 0) {}

void Crossings::begin(TS ts) {
  double t = 0;
  Vec U = nullptr, V = nullptr;
  check(TSGetTime(ts, &t));
  check(TS2GetSolution(ts, &U, &V));
  searched_ = -1, back_ = arrived_ = false;
  for (std::size_t i = 0; i < events_.size(); ++i)
    if (events_[i].crosses) value_[i] = value(i, t, U, V);
}

/// Where the event's function vanishes on the step's interpolant: regula falsi, Illinois variant.
double Crossings::locate(TS ts, std::size_t event, double before, double after) const {
  double t0 = 0, t1 = 0;
  Vec U1 = nullptr, V = nullptr;
  check(TSGetPrevTime(ts, &t0));
  check(TSGetTime(ts, &t1));
  check(TS2GetSolution(ts, &U1, &V));
  petsc::VecHandle U;
  check(VecDuplicate(U1, U.out()));
  const double small = 1e-13 * (t1 - t0) + 4e-16 * std::abs(t1);
  double low = t0, high = t1, at = t1;
  for (int i = 0; i < 100 && high - low > small; ++i) {
    at = (low * after - high * before) / (after - before);
    if (!(at > low && at < high)) at = 0.5 * (low + high);
    check(TSInterpolate(ts, at, U));
    const double here = value(event, at, U, V);
    if (here == 0) break;
    if ((here < 0) == (after < 0)) {
      high = at, after = here, before /= 2;
    } else {
      low = at, before = here, after /= 2;
    }
  }
  return at;
}

void Crossings::after_step(TS ts) {
  double t = 0;
  Vec U = nullptr, V = nullptr;
  check(TSGetTime(ts, &t));
  check(TS2GetSolution(ts, &U, &V));
  double first = t, begin = 0;
  check(TSGetPrevTime(ts, &begin));
  if (searched_ >= 0) {
    back_ = false;
    arrived_ = target_ - t <= 1e-9 * (t - begin);
    if (arrived_) return check(TSSetConvergedReason(ts, TS_CONVERGED_USER));
    double next = 0;  // the step was cut for other reasons
    check(TSGetTimeStep(ts, &next));
    return check(TSSetTimeStep(ts, std::min(next, target_ - t)));
  }
  std::vector<double> now(events_.size(), 0);
  for (std::size_t i = 0; i < events_.size(); ++i) {
    if (!events_[i].crosses || happened_[i] != 0) continue;
    now[i] = value(i, t, U, V);
    if (value_[i] == 0 || now[i] * value_[i] > 0) continue;
    const double at = now[i] == 0 ? t : locate(ts, i, value_[i], now[i]);
    if (searched_ >= 0 && at >= first) continue;
    searched_ = static_cast<int>(i), first = at;
  }
  value_ = now;
  if (searched_ < 0) return;
  arrived_ = t - first <= 1e-9 * (t - begin);  // the step's end
  if (arrived_) return check(TSSetConvergedReason(ts, TS_CONVERGED_USER));
  target_ = std::max(first, begin + 1e-9 * (t - begin));
  back_ = true;
  check(TSRollBack(ts));
  check(TSSetTimeStep(ts, target_ - begin));
}

}  // namespace floe::dynamics
