#include "floe/solve/path.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "floe/solve/start.h"
#include "gather_to_all.h"
#include "path_equations.h"
#include "rotating_axes.h"

namespace floe::solve {

using petsc::check;

namespace {

constexpr int most_iterations = 15, good_iterations = 4;
constexpr double good_angle = 0.15, max_angle = 0.5;  // of tangent and chord within a step [rad]
constexpr double min_share = 1e-4;                    // of the length of the first step
constexpr double min_first = 1e-8;                    // of the length tried first, for the first step

/// An equilibrium with the direction in which the path goes on, of size one.
struct PathState {
  PathVector at, direction;
};

class PathFollower {
 public:
  using Observe = std::function<void(const PathPoint&, Vec)>;
  PathFollower(const System& system, double t, const PathRequest& request, Vec U, Vec V, const Observe& observe)
      : system_(system),
        request_(request),
        U_(U),
        weights_(root_masses(system, t, U, V)),
        equations_(system, 1e-5 * request.first, V, weights_),
        observe_(observe),
        solutions_{system.create_vector(), system.create_vector()} {
    now_.at = equations_.vector(), now_.direction = equations_.vector();
    check(VecCopy(U, now_.at.U));
    now_.at.t = t, end_.points = request.number;
  }

  PathEnd go() {
    end_.at_end = now_.at.t == request_.end;
    if (end_.at_end) return end_;
    start();
    while (end_.points < request_.most && !end_.at_end && !end_.closed) {
      PathState next = step();
      const double side = std::copysign(1, next.direction.t);
      const bool limit = side != side_;
      const bool located = limit && refine_limit(next);
      side_ = side;
      const bool crosses = (now_.at.t - request_.end) * (next.at.t - request_.end) <= 0;
      if (crosses) finish(next);
      end_.at_end = crosses;
      using Limit = PathPoint::Limit;
      accept(next, !limit || crosses ? Limit::none : located ? Limit::at : Limit::within);
    }
    return end_;
  }

 private:
  PathState state() const { return {equations_.vector(), equations_.vector()}; }

  void start() {
    if (!equations_.solve(now_.at, solutions_)) throw nothing_holds();
    const double rate =
        std::max(weighted_size(solutions_.a, weights_), equations_.max_chord(now_.at, request_.first, request_.end));
    equations_.beta = rate > 0 ? rate : 1;
    check(VecCopy(solutions_.a, now_.direction.U));
    now_.direction.t = 1;
    const double size = equations_.size(now_.direction), sign = request_.end > now_.at.t ? 1 : -1;
    check(VecScale(now_.direction.U, sign / size));
    now_.direction.t = sign / size;
    side_ = sign;
    first_ = length_ = request_.first * size;
  }

  /// The next point, by the longest step that converges.
  PathState step() {
    std::string why;
    const bool begins = end_.points == request_.number && !rough_start_;
    const double least = (begins ? min_first : min_share) * first_;
    for (; length_ >= least; length_ /= 2) {
      const double most = 1.0001 * request_.first / std::max(std::abs(now_.direction.t), 1e-300);
      length_ = std::min(length_, most);
      try {
        const bool shortest = !begins && length_ < 2 * least;  // at a kink of the path
        Tried tried = correct(length_, why, shortest ? 4 : 0.5);
        if (!tried.state) continue;
        if (tried.rotation > max_angle && !shortest) continue;
        taken_ = length_;
        length_ *= std::clamp(std::min(good_angle / std::max(tried.rotation, 1e-3),
                                       std::sqrt(double(good_iterations) / tried.iterations)),
                              0.5, 2.);
        if (begins) first_ = taken_;
        length_ = std::max(length_, min_share * first_);
        return std::move(*tried.state);
      } catch (const petsc::Error&) {
        throw;
      } catch (const std::runtime_error& error) {  // also of formulas
        why = error.what();
      }
    }
    if (begins) {  // a load of infinite rate at the start, sqrt(t): a step as at a kink
      rough_start_ = true, length_ = 1.9 * min_share * first_;
      return step();
    }
    throw RunError(
        fmt::format("the path of equilibria cannot be followed beyond t = {:.6g} (point {}): steps down to {:.0e} of "
                    "the first fail{}"
                    "; possible causes: a sudden load or stop, a bifurcation, too few --steps",
                    now_.at.t, end_.points, min_share, why.empty() ? "" : " (" + why + ")"));
  }

  struct Tried {
    std::optional<PathState> state;
    int iterations = 0;
    double rotation = 0;
  };

  /// Newton's method from the predictor of a step, in the plane across the direction, no further away from it than this
  /// share of the length.
  Tried correct(double length, std::string& why, double most_away = 0.5) {
    PathState next = state();
    set_to(next.at, now_.at);
    add_to(next.at, length, now_.direction);
    PathVector change = equations_.vector(), away = equations_.vector();
    Tried tried;
    double last = INFINITY;
    while (tried.iterations < most_iterations) {
      ++tried.iterations, ++end_.iterations;
      if (!equations_.solve(next.at, solutions_)) {
        why = "singular tangent stiffness";
        return {};
      }
      correction(change);
      add_to(next.at, 1, change), add_to(away, 1, change);
      const double size = equations_.size(change), gone = equations_.size(away);
      if (!(gone <= most_away * length)) {
        why = "Newton's method leaves the path";
        return {};
      }
      if (size <= 1e-9 * length || (size <= 1e-6 * length && size >= 0.5 * last)) {
        tried.rotation = point_on(next);
        tried.state = std::move(next);
        return tried;
      }
      last = size;
    }
    why = fmt::format("Newton's method does not converge in {} iterations", most_iterations);
    return {};
  }

  /// b + dt a, across the direction.
  void correction(PathVector& change) const {
    const PathVector& n = now_.direction;
    const double na = weighted_product(n.U, solutions_.a, weights_) + equations_.beta * equations_.beta * n.t,
                 nb = weighted_product(n.U, solutions_.b, weights_);
    change.t = -nb / na;
    check(VecWAXPY(change.U, change.t, solutions_.a, solutions_.b));
  }

  /// The direction at the last point of Newton's method, on from the present one. @return  the rotation of the tangent
  /// [rad], or twice the angle between the chord and one of the tangents, whichever is larger: all are the same on an
  /// arc of a circle; the chord to another branch differs from tangents that agree
  double point_on(PathState& next) const {
    PathVector& direction = next.direction;
    check(VecCopy(solutions_.a, direction.U));
    direction.t = 1;
    const double size = equations_.size(direction), along = equations_.product(direction, now_.direction) / size,
                 scale = std::copysign(1 / size, along);
    check(VecScale(direction.U, scale));
    direction.t = scale;
    PathVector chord = equations_.vector();
    set_to(chord, next.at);
    add_to(chord, -1, now_.at);
    const double length = equations_.size(chord);
    const auto angle = [](double cosine) { return std::acos(std::clamp(cosine, -1., 1.)); };
    return std::max({angle(std::abs(along)), 2 * angle(equations_.product(chord, now_.direction) / length),
                     2 * angle(equations_.product(chord, direction) / length)});
  }

  /// Where dt/ds has changed its sign within the step: the point where it vanishes, to 1e-6 of its larger value at the
  /// ends of the step, by regula falsi (Illinois). @return  false: Newton's method fails beside it, or formulas have no
  /// value; the point found last is kept
  bool refine_limit(PathState& next) {
    double low = 0, high = taken_, f_low = now_.direction.t, f_high = next.direction.t;
    const double small = 1e-6 * std::max(std::abs(f_low), std::abs(f_high));
    int last = 0;
    for (int i = 0; i < 30 && std::abs(next.direction.t) > small; ++i) {
      const double s = (low * f_high - high * f_low) / (f_high - f_low);
      const Tried tried = tried_at(s);
      if (!tried.state) break;
      set_to(next.at, tried.state->at), set_to(next.direction, tried.state->direction);
      const int side = next.direction.t * f_high > 0 ? 1 : -1;
      (side > 0 ? high : low) = s, (side > 0 ? f_high : f_low) = next.direction.t;
      if (side == last) (side > 0 ? f_low : f_high) /= 2;
      last = side;
    }
    length_ = std::max(taken_ / 2, min_share * first_);
    return std::abs(next.direction.t) <= small;
  }
  Tried tried_at(double length) {
    std::string why;
    try {
      return correct(length, why);
    } catch (const petsc::Error&) {
      throw;
    } catch (const std::runtime_error&) {  // of formulas
      return {};
    }
  }

  /// Newton's method at t = end, from the chord between the present point and the one beyond.
  void finish(PathState& beyond) {
    const double span = beyond.at.t - now_.at.t, share = span == 0 ? 1 : (request_.end - now_.at.t) / span;
    check(VecAXPBY(beyond.at.U, 1 - share, share, now_.at.U));
    beyond.at.t = request_.end;
    double last = INFINITY;
    for (int i = 0; i < most_iterations; ++i) {
      ++end_.iterations;
      if (!equations_.solve(beyond.at, solutions_)) break;
      check(VecAXPY(beyond.at.U, 1, solutions_.b));
      const double size = weighted_size(solutions_.b, weights_);
      if (size <= 1e-9 * taken_ || (size <= 1e-6 * taken_ && size >= 0.5 * last)) return;
      last = size;
    }
    throw RunError(fmt::format("the path of equilibria reaches t = {:.6g}, but Newton's method does not converge there",
                               request_.end));
  }

  /// Whether the present limit point is one found before; rotations of frames count. Their bases are those of U_.
  bool returns() {
    PathVector way = equations_.vector();
    bool back = false;
    for (const LimitPoint& point : limits_) {
      set(way.U, point.state.change_to(U_));
      way.t = now_.at.t - point.t;
      back = back || equations_.size(way) < 1e-3 * (travelled_ - point.travelled);
    }
    limits_.push_back({KeptState(system_, U_), now_.at.t, travelled_});
    return back;
  }

  void accept(PathState& next, PathPoint::Limit limit) {
    PathVector way = equations_.vector();
    set_to(way, next.at);
    add_to(way, -1, now_.at);
    travelled_ += equations_.size(way);
    now_ = std::move(next);
    check(VecCopy(now_.at.U, U_));
    system_.rebase(U_);
    check(VecCopy(U_, now_.at.U));
    const System::FailedConstraint failed = system_.failed_constraint(now_.at.t, U_);
    if (!failed.joint.empty())
      throw RunError(fmt::format("the path of equilibria ends at t = {:.6g}: {}", now_.at.t, failed.text()));
    ++end_.points;
    end_.closed = limit == PathPoint::Limit::at && returns();
    observe_({end_.points, now_.at.t, limit, end_.at_end || end_.closed || end_.points == request_.most}, U_);
  }

  Unconstrained nothing_holds() const {
    return Unconstrained(
        fmt::format("the path of equilibria cannot begin at t = {:.6g}: singular tangent stiffness; "
                    "constrain the unconstrained motion",
                    now_.at.t));
  }

  const System& system_;
  PathRequest request_;
  Vec U_;
  petsc::VecHandle weights_;
  PathEquations equations_;
  const Observe& observe_;
  PathSolutions solutions_;
  PathState now_;
  PathEnd end_;
  struct LimitPoint {
    KeptState state;
    double t, travelled;  // length of the path up to it
  };
  std::vector<LimitPoint> limits_;
  double first_ = 0, length_ = 0, taken_ = 0, travelled_ = 0;
  bool rough_start_ = false;
  double side_ = 1;  // sign of dt/ds behind the last point
};

}  // namespace

PathEnd follow_path(const System& system, double t, const PathRequest& request, Vec U, Vec V,
                    const std::function<void(const PathPoint&, Vec)>& observe) {
  return PathFollower(system, t, request, U, V, observe).go();
}

}  // namespace floe::solve
