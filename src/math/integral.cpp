#include "floe/math/integral.h"

#include <algorithm>
#include <array>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>
#include <vector>

namespace floe::math {

namespace {

using Rule = boost::math::quadrature::gauss_kronrod<double, 15>;

/// Integral, estimate of its error and integral of |f|, from <= to.
struct Estimate {
  double value, error, size;
  Estimate(const std::function<double(double)>& f, double from, double to) {
    value = Rule::integrate(f, from, to, 0, 0, &error, &size);
    error *= (to - from) / 2;  // Boost gives it for an interval of length 2
  }
};

constexpr int most_halvings = 46, most_without_gain = 10;

/// Halves until each part is known to `error`, or as short as a jump can be distinguished from; the tolerance does not
/// shrink with the parts, because only those at corners and jumps are halved often. Of round-off both halves keep their
/// share of the error, of a corner or a jump one: parts that were halved so again and again remain as they are.
double adaptive(const std::function<double(double)>& f, double from, double to, const Estimate& whole, double error,
                int halvings = most_halvings, int without_gain = most_without_gain) {
  if (whole.error <= error || halvings == 0 || without_gain == 0) return whole.value;
  const double middle = (from + to) / 2;
  const Estimate first(f, from, middle), second(f, middle, to);
  if (std::min(first.error, second.error) > whole.error / 100) --without_gain;
  return adaptive(f, from, middle, first, error, halvings - 1, without_gain) +
         adaptive(f, middle, to, second, error, halvings - 1, without_gain);
}

}  // namespace

struct Integral::Kept {
  std::function<double(double)> f;
  double panel;
  std::vector<double> breaks;
  std::array<std::vector<double>, 2> until;  // int_0^(k panel), forwards and backwards in time

  double over(double from, double to) const {
    if (from == to) return 0;
    if (to < from) return -over(to, from);
    double sum = 0, begin = from;
    const auto add = [&](double end) {
      const Estimate part(f, begin, end);
      sum += adaptive(f, begin, end, part, 1e-14 * part.size);
      begin = end;
    };
    for (auto at = std::upper_bound(breaks.begin(), breaks.end(), from); at != breaks.end() && *at < to; ++at) add(*at);
    add(to);
    return sum;
  }
};

Integral::Integral(std::function<double(double)> f, double panel, std::vector<double> breaks)
    : kept_(std::make_shared<Kept>(
          Kept{std::move(f), panel, std::move(breaks), {std::vector<double>{0}, std::vector<double>{0}}})) {}

double Integral::operator()(double t) const {
  const double side = t < 0 ? -1 : 1;
  std::vector<double>& until = kept_->until[t < 0 ? 1 : 0];
  const std::size_t whole = static_cast<std::size_t>(std::floor(std::abs(t) / kept_->panel));
  const auto at = [&](std::size_t k) { return side * static_cast<double>(k) * kept_->panel; };
  while (until.size() <= whole) until.push_back(until.back() + kept_->over(at(until.size() - 1), at(until.size())));
  return until[whole] + kept_->over(at(whole), t);
}

}  // namespace floe::math
