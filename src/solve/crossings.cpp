#include "crossings.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "floe/petsc/handle.h"
#include "floe/solve/generalized_alpha.h"

namespace floe::solve {

using petsc::check;

Crossings::Crossings(const std::vector<Event>& events, std::vector<double>& happened, double step,
                     const std::function<void(const EventReport&)>& on_event)
    : events_(events), happened_(happened), step_(step), on_event_(on_event) {}

Crossings::Seen Crossings::see(double t, Vec U, Vec V) const {
  Seen seen{std::vector<double>(events_.size(), 0), std::vector<double>(events_.size(), 0)};
  for (std::size_t i = 0; i < events_.size(); ++i) {
    if (events_[i].repeats()) {
      const auto [value, rate] = events_[i].gap(t, U, V);
      seen.value[i] = value, seen.rate[i] = rate;
    } else if (events_[i].crosses && happened_[i] == 0) {
      seen.value[i] = events_[i].crosses(t, U, V);
    }
  }
  return seen;
}

void Crossings::begin(TS ts) {
  double t = 0;
  Vec U = nullptr, V = nullptr;
  check(TSGetTime(ts, &t));
  check(TS2GetSolution(ts, &U, &V));
  searched_ = -1, back_ = arrived_ = false;
  located_.assign(events_.size(), 0);
  before_ = see(t, U, V);
  shorten(ts, before_);
  for (std::size_t i = 0; i < events_.size(); ++i)
    if (events_[i].repeats() && happened_[i] == 0) happened_[i] = before_.value[i] < 0 ? -1 : 1;
}

/// Adaptive steps end before a stop that they approach, and begin at it so short that its force sets in within several
/// of them: of a step that begins before the stop and ends at it, accelerations are zero at both ends, and so is the
/// estimate of its error.
void Crossings::shorten(TS ts, const Seen& now) const {
  constexpr double share = 0.9;  // of the way
  if (step_ > 0) return;
  double next = 0, most = std::numeric_limits<double>::infinity();
  check(TSGetTimeStep(ts, &next));
  for (std::size_t i = 0; i < events_.size(); ++i)
    if (now.rate[i] < 0 && now.value[i] > -events_[i].width)
      most = std::min(most, std::max(share * now.value[i], events_[i].width / 2) / -now.rate[i]);
  if (most < next) check(TSSetTimeStep(ts, most));
}

/// Whether an adaptive step begins before a stop, ends in it, and moves further than the width over which its force
/// sets in. While a mass falls, its acceleration is constant and the estimated error of a step of any length is zero;
/// the force at the end of such a step would give it an arbitrary velocity.
bool Crossings::passes_over(double h, const Seen& now) const {
  if (step_ > 0) return false;
  for (std::size_t i = 0; i < events_.size(); ++i)
    if (events_[i].repeats() && before_.value[i] > 0 && now.value[i] < 0 &&
        h * std::max(std::abs(before_.rate[i]), std::abs(now.rate[i])) > events_[i].width)
      return true;
  return false;
}

/// The step that was taken last, to be taken again h long.
void Crossings::take_back(TS ts, double h) {
  back_ = true;
  check(TSRollBack(ts));
  check(TSSetConvergedReason(ts, TS_CONVERGED_ITERATING));  // the step that is taken back may have come to the end
  check(TSSetTimeStep(ts, h));
}

namespace {

/// Events within this share of a step are at one instant.
constexpr double same = 1e-6;

}  // namespace

/// The event's function on the step's interpolant.
double Crossings::within(const Step& step, std::size_t event, double t) const {
  petsc::VecHandle U, V, A;
  for (petsc::VecHandle* one : {&U, &V, &A}) check(VecDuplicate(step.U, one->out()));
  check(TSGeneralizedAlphaInterpolate(step.ts, t, U, V, A));
  return events_[event].repeats() ? events_[event].gap(t, U, V)[0] : events_[event].crosses(t, U, V);
}

/// Where the event's function vanishes on the step's interpolant: regula falsi, Illinois variant.
double Crossings::locate(const Step& step, std::size_t event, double low, double high, double before,
                         double after) const {
  const double small = 1e-13 * (step.end - step.begin) + 4e-16 * std::abs(step.end);
  double at = high;
  for (int i = 0; i < 100 && high - low > small; ++i) {
    at = (low * after - high * before) / (after - before);
    if (!(at > low && at < high)) at = 0.5 * (low + high);
    const double here = within(step, event, at);
    if (here == 0) break;
    if ((here < 0) == (after < 0)) {
      high = at, after = here, before /= 2;
    } else {
      low = at, before = here, after /= 2;
    }
  }
  return at;
}

namespace {

/// Where the cubic through values and rates at both ends of a step of length h has its greatest value, 0 < s < 1; else
/// nothing. It rises at s = 0.
std::optional<double> top(double g0, double r0, double g1, double r1, double h) {
  // g' / h = r0 + s b + s^2 a
  const double rise = (g1 - g0) / h, b = 6 * rise - 4 * r0 - 2 * r1, a = 3 * (r0 + r1) - 6 * rise;
  const double root = b * b - 4 * a * r0;
  if (!(r0 > 0) || root < 0) return {};
  const double s = -2 * r0 / (b - std::sqrt(root));  // where it falls again
  return s > 0 && s < 1 ? std::optional(s) : std::nullopt;
}

}  // namespace

/// Of an event that repeats. A value that is zero but for round-off, where the step before ended at the event, counts
/// as zero: so it does after a restart there.
std::optional<double> Crossings::change_of_side(const Step& step, std::size_t i, const Seen& now) const {
  const double side = happened_[i], h = step.end - step.begin;
  double before = side * before_.value[i];
  const double after = side * now.value[i], r0 = side * before_.rate[i], r1 = side * now.rate[i];
  if (std::abs(before) <= 1e-8 * h * (std::abs(r0) + std::abs(r1)) + 1e-14 * std::abs(after)) before = 0;
  const auto between = [&](double low, double high, double at_low, double at_high) {
    return locate(step, i, low, high, side * at_low, side * at_high);
  };
  if (after < 0) {
    if (before > 0) return between(step.begin, step.end, before, after);
    if (const auto s = top(before, r0, after, r1, h))
      if (const double there = step.begin + *s * h, high = side * within(step, i, there); high > 0)
        return between(there, step.end, high, after);
    return step.begin;
  }
  if (before < 0) return {};  // comes back to its side
  const auto s = top(-before, -r0, -after, -r1, h);
  if (!s) return {};
  const double there = step.begin + *s * h, low = side * within(step, i, there);
  if (!(low < 0)) return {};
  return before > 0 ? between(step.begin, there, before, low) : step.begin;
}

/// Of an event whose function has one sign at both ends of the step: where it has the other one between. It is seen in
/// the middle, in adaptive steps at all quarters, and at the vertex of the parabola through the least of these values
/// and its neighbours, which moves to there until it stays; not where the parabola has no minimum, or one that is
/// clearly on the same side.
std::optional<double> Crossings::visit(const Step& step, std::size_t i, const Seen& now) const {
  struct Sample {
    double s, value;
  };
  constexpr double likely = 0.25;  // of the least value: what a parabola may miss
  const int parts = step_ > 0 ? 2 : 4;
  const double h = step.end - step.begin, sign = before_.value[i] < 0 ? -1 : 1;
  const auto at = [&](double s) { return Sample{s, sign * within(step, i, step.begin + s * h)}; };
  std::vector<Sample> all{{0, sign * before_.value[i]}};
  for (int k = 1; k < parts; ++k) all.push_back(at(static_cast<double>(k) / parts));
  all.push_back({1, sign * now.value[i]});
  for (int vertices = 0;; ++vertices) {
    const auto least = std::ranges::min_element(all, {}, &Sample::value);
    if (least->value < 0)
      return locate(step, i, step.begin, step.begin + least->s * h, before_.value[i], sign * least->value);
    const auto k = std::clamp<std::ptrdiff_t>(least - all.begin(), 1, std::ssize(all) - 2);
    const Sample &left = all[k - 1], &middle = all[k], &right = all[k + 1];
    const double rise = (right.value - middle.value) / (right.s - middle.s),
                 fall = (middle.value - left.value) / (middle.s - left.s),
                 curvature = (rise - fall) / (right.s - left.s);
    if (!(curvature > 0) || vertices == 4) return {};
    const double slope = fall + curvature * (middle.s - left.s), way = -slope / (2 * curvature), s = middle.s + way;
    if (!(s > 0 && s < 1) || middle.value + 0.5 * slope * way > likely * least->value) return {};
    const auto after = std::ranges::upper_bound(all, s, {}, &Sample::s);
    if (s - std::prev(after)->s < 1e-3 || after->s - s < 1e-3) return {};
    all.insert(after, at(s));
  }
}

std::optional<double> Crossings::crossing(const Step& step, std::size_t i, const Seen& now) const {
  if (events_[i].repeats()) return change_of_side(step, i, now);
  if (!events_[i].crosses || happened_[i] != 0 || before_.value[i] == 0) return {};
  if (now.value[i] * before_.value[i] > 0) return visit(step, i, now);
  if (now.value[i] == 0) return step.end;
  return locate(step, i, step.begin, step.end, before_.value[i], now.value[i]);
}

/// The events that have happened since the step's beginning, where it ends at the first of them: beside this one those
/// that the interpolant has at the same instant, and those whose functions have changed their signs.
void Crossings::mark_located(const Seen& now) {
  for (std::size_t i = 0; i < events_.size(); ++i) {
    if (events_[i].repeats() || !events_[i].crosses || happened_[i] != 0) continue;
    const bool passed = before_.value[i] != 0 && now.value[i] * before_.value[i] <= 0;
    if (passed || searched_ == static_cast<int>(i)) located_[i] = 1;
  }
}

void Crossings::report(std::size_t i, double t, double rate) {
  EventReport found{events_[i].name, happened_[i] > 0 ? events_[i].what : events_[i].what_back, t};
  found.speed = std::abs(rate);
  happened_[i] = -happened_[i];
  if (on_event_) on_event_(found);
}

/// The next step after an event that changes nothing: as long as if it had not been.
void Crossings::go_on(const Step& step) {
  double end = 0;
  check(TSGetMaxTime(step.ts, &end));
  const double next = step_ > 0 ? step_ : whole_;
  if (end > step.end) check(TSSetTimeStep(step.ts, std::min(next, end - step.end)));
  shorten(step.ts, before_);
}

namespace {

/// An event that repeats and is so near an end of its step, in shares of it, is reported and no step ends there: a
/// stop's force begins at zero with slope zero, and steps much smaller than their neighbours only spoil Newton's
/// method.
constexpr double close = 1e-3;

}  // namespace

/// A step that was taken again: whether it has come to where the event is, and what happens there.
void Crossings::after_step_again(const Step& step) {
  const double h = step.end - step.begin;
  back_ = false;
  arrived_ = target_ - step.end <= 1e-9 * h;
  if (!arrived_) {
    double next = 0;  // the step was cut for other reasons
    check(TSGetTimeStep(step.ts, &next));
    return check(TSSetTimeStep(step.ts, std::min(next, target_ - step.end)));
  }
  const Seen now = see(step.end, step.U, step.V);
  if (!events_[searched_].repeats()) {
    mark_located(now);
    return check(TSSetConvergedReason(step.ts, TS_CONVERGED_USER));
  }
  before_ = now;
  const double rate = before_.rate[searched_], short_of = rate != 0 ? -before_.value[searched_] / rate : 0;
  if (short_of <= close * whole_)  // else the force set in or ended within the step, and the next one finds it
    report(searched_, step.end + std::max(short_of, -h), rate);
  searched_ = -1, arrived_ = false;
  go_on(step);
}

/// Where the first event of the step is, which becomes the one that is searched; those at the same instant are located.
double Crossings::find_first(const Step& step, const Seen& now) {
  const double h = step.end - step.begin;
  double first = step.end;
  std::vector<double> instants(events_.size(), std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < events_.size(); ++i) {
    std::optional<double> at = crossing(step, i, now);
    if (at && events_[i].repeats() && *at - step.begin <= close * h) {
      report(i, *at, before_.rate[i]);
      at = crossing(step, i, now);                          // it may come back within the step
      if (at && *at - step.begin <= close * h) at.reset();  // seen in the next one
    }
    if (at && !events_[i].repeats()) instants[i] = *at;
    if (!at || (searched_ >= 0 && *at >= first)) continue;
    searched_ = static_cast<int>(i), first = *at;
  }
  const bool repeats = searched_ >= 0 && events_[searched_].repeats();
  for (std::size_t i = 0; i < events_.size(); ++i) located_[i] = !repeats && instants[i] <= first + same * h;
  return first;
}

void Crossings::after_step(TS ts) {
  Step step{ts, 0, 0, nullptr, nullptr};
  check(TSGetTime(ts, &step.end));
  check(TS2GetSolution(ts, &step.U, &step.V));
  check(TSGetPrevTime(ts, &step.begin));
  if (searched_ >= 0) return after_step_again(step);
  back_ = false;
  const double h = step.end - step.begin;
  const Seen now = see(step.end, step.U, step.V);
  if (passes_over(h, now)) return take_back(ts, h / 2);
  const double first = find_first(step, now);
  if (searched_ < 0) {
    before_ = now;
    return shorten(ts, now);
  }
  const bool repeats = events_[searched_].repeats();
  arrived_ = step.end - first <= (repeats ? close : 1e-9) * h;  // the step's end
  if (arrived_) {
    if (!repeats) mark_located(now);
    before_ = now;
    if (!repeats) return check(TSSetConvergedReason(ts, TS_CONVERGED_USER));
    report(searched_, first, now.rate[searched_]);
    searched_ = -1, arrived_ = false;
    return shorten(ts, now);
  }
  target_ = std::max(first, step.begin + 1e-9 * h);
  whole_ = h;
  take_back(ts, target_ - step.begin);
}

}  // namespace floe::solve
