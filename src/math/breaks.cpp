#include "floe/math/breaks.h"

#include <algorithm>
#include <cmath>

#include "expression.h"

namespace floe::math {
namespace {

/// The formula at one time: its derivatives, its switches, and their signs, which identify the branch.
struct Sample {
  double t = 0;
  Jet jet;
  std::vector<Jet> switches;
  std::vector<signed char> signs;
};

/// The formula as a function of its first variable.
class OfTime {
 public:
  OfTime(const Expression& f, std::span<const double> others) : f_(f), variables_(1, 0.0) {
    variables_.insert(variables_.end(), others.begin(), others.end());
  }
  Jet operator()(double t) const {
    variables_[0] = t;
    return f_(variables_);
  }
  Jet operator()(double t, std::vector<Jet>& switches) const {
    variables_[0] = t;
    return f_(variables_, switches);
  }

 private:
  const Expression& f_;
  mutable std::vector<double> variables_;
};

Sample sample(const OfTime& f, double t) {
  Sample at{t, {}, {}, {}};
  at.jet = f(t, at.switches);
  for (const Jet& s : at.switches) at.signs.push_back(s.value > 0 ? 1 : s.value < 0 ? -1 : 0);
  return at;
}

std::array<double, 3> values(const Jet& jet) { return {jet.value, jet.first, jet.second}; }

/// Round-off of a time, or of the time that a step takes.
double margin(double t, double spacing) { return std::max(4 * (std::nextafter(t, INFINITY) - t), 1e-15 * spacing); }

class Search {
 public:
  Search(const OfTime& f, double from, double spacing, Breaks& found)
      : f_(f), from_(from), spacing_(spacing), found_(found) {}

  /// Between two samples: at each change of branch.
  void between(Sample low, const Sample& end) {
    constexpr int most = 64;
    for (int count = 0; low.signs != end.signs && count < most; ++count) {
      Sample high = end;
      for (int halving = 0; halving < 1100; ++halving) {
        const double middle = 0.5 * (low.t + high.t);
        if (!(middle > low.t && middle < high.t) || high.t - low.t < 1e-17 * spacing_) break;
        Sample there = sample(f_, middle);
        (there.signs == low.signs ? low : high) = std::move(there);
      }
      add(low.t, high.t);
      low = std::move(high);
    }
  }

 private:
  /// A zero between two signs gives two changes, which are one.
  void add(double before, double after) {
    before = std::max(from_, before - margin(before, spacing_)), after += margin(after, spacing_);
    if (!found_.at.empty() && before <= found_.at.back().after) {
      before = found_.at.back().before;
      found_.at.pop_back();
    }
    found_.at.push_back({before, after, values(f_(before)), values(f_(after))});
  }

  const OfTime& f_;
  double from_, spacing_;
  Breaks& found_;
};

/// Where switches of the sample vanish within (begin, end), as far as they are linear.
void predict(const Sample& at, double begin, double end, std::vector<double>& times) {
  for (const Jet& s : at.switches) {
    const double zero = at.t - s.value / s.first;
    if (s.first != 0 && zero > begin && zero < end) times.push_back(zero);
  }
}

}  // namespace

Breaks breaks(const Formula& formula, double from, double to, double spacing, std::span<const double> others) {
  constexpr double most = 1e5;
  Breaks found;
  const Expression* tree = formula.expression();
  if (!tree || !tree->has_switches() || !(to > from)) return found;
  const OfTime f(*tree, others);
  const double count = std::clamp(std::ceil((to - from) / spacing), 1.0, most);
  Search search(f, from, spacing, found);
  Sample low = sample(f, from);
  for (double i = 0; i < count; ++i) {
    const Sample high = sample(f, i + 1 < count ? from + (to - from) * (i + 1) / count : to);
    for (int k = 0; const double value : values(high.jet)) {
      if (std::isfinite(value)) found.size[k] = std::max(found.size[k], std::abs(value));
      ++k;
    }
    std::vector<double> times;
    predict(low, low.t, high.t, times), predict(high, low.t, high.t, times);
    std::sort(times.begin(), times.end());
    times.erase(std::unique(times.begin(), times.end()), times.end());
    for (std::size_t k = times.size(); k > 1; --k) times.push_back(0.5 * (times[k - 1] + times[k - 2]));
    std::sort(times.begin(), times.end());
    for (const double t : times) {
      Sample there = sample(f, t);
      search.between(std::move(low), there);
      low = std::move(there);
    }
    search.between(std::move(low), high);
    low = high;
  }
  return found;
}

}  // namespace floe::math
