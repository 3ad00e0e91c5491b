#include <algorithm>
#include <cmath>

#include "floe/math/formula.h"
#include "function.h"

namespace floe::math {
namespace {

/// Derivatives at the points of a monotone cubic (Fritsch and Carlson 1980; weights of Fritsch and Butland 1984).
std::vector<double> slopes(const Table& table) {
  const std::vector<double>&x = table.x, &y = table.y;
  const std::size_t n = x.size();
  std::vector<double> secant(n - 1), slope(n, 0);
  for (std::size_t i = 0; i + 1 < n; ++i) secant[i] = (y[i + 1] - y[i]) / (x[i + 1] - x[i]);
  const auto inner = [](double before, double after, double width_before, double width_after) {
    if (before * after <= 0) return 0.0;
    const double a = 2 * width_after + width_before, b = width_after + 2 * width_before;
    return (a + b) / (a / before + b / after);
  };
  for (std::size_t i = 1; i + 1 < n; ++i) slope[i] = inner(secant[i - 1], secant[i], x[i] - x[i - 1], x[i + 1] - x[i]);
  if (table.periodic) {
    slope[0] = slope[n - 1] = inner(secant[n - 2], secant[0], x[n - 1] - x[n - 2], x[1] - x[0]);
    return slope;
  }
  const auto end = [](double own, double next, double width, double next_width) {  // of three points, kept monotone
    const double d = ((2 * width + next_width) * own - width * next) / (width + next_width);
    if (d * own <= 0) return 0.0;
    return own * next <= 0 && std::abs(d) > 3 * std::abs(own) ? 3 * own : d;
  };
  if (n == 2) {
    slope[0] = slope[1] = secant[0];
    return slope;
  }
  slope[0] = end(secant[0], secant[1], x[1] - x[0], x[2] - x[1]);
  slope[n - 1] = end(secant[n - 2], secant[n - 3], x[n - 1] - x[n - 2], x[n - 2] - x[n - 3]);
  return slope;
}

class FunctionOfTable final : public Function {
 public:
  explicit FunctionOfTable(Table table) : table_(std::move(table)) {
    if (!linear()) slope_ = slopes(table_);
  }

  Jet operator()(const Jet& argument, std::vector<Jet>* switches) const override {
    const std::vector<double>&x = table_.x, &y = table_.y;
    Jet at = argument;
    const double period = x.back() - x.front();
    const double periods = table_.periodic ? std::floor((at.value - x.front()) / period) : 0;
    at.value -= periods * period;
    const auto next = std::upper_bound(x.begin() + 1, x.end() - 1, at.value);
    const auto i = static_cast<std::size_t>(next - x.begin()) - 1;
    if (switches) add_switches(at, i, periods, *switches);
    if (!table_.periodic && at.value < x.front()) return Jet{y.front()};
    if (!table_.periodic && at.value >= x.back()) return Jet{y.back()};
    const double width = x[i + 1] - x[i], rise = y[i + 1] - y[i], s = (at.value - x[i]) / width;
    if (linear()) return chain(at, y[i] + s * rise, rise / width, 0);
    // y_i + s (m_i + s (c + s d)), m in units of the interval
    const double m = slope_[i] * width, c = 3 * rise - 2 * m - slope_[i + 1] * width,
                 d = m + slope_[i + 1] * width - 2 * rise;
    return chain(at, y[i] + s * (m + s * (c + s * d)), (m + s * (2 * c + s * 3 * d)) / width,
                 (2 * c + 6 * s * d) / (width * width));
  }
  bool has_switches() const override { return true; }

 private:
  bool linear() const { return table_.interpolation == Table::Interpolation::linear; }
  /// A quantity that changes its sign at every point, where the first or the second derivative jumps.
  void add_switches(const Jet& at, std::size_t i, double periods, std::vector<Jet>& switches) const {
    const std::vector<double>& x = table_.x;
    const Jet left = at - Jet{x[i]}, right = Jet{x[i + 1]} - at;
    const bool first = at.value - x[i] < x[i + 1] - at.value;
    // within interval k (-1)^k times the distance to the nearer of its points
    const double k = static_cast<double>(i) + periods * static_cast<double>(x.size() - 1);
    const double sign = std::fmod(k, 2) == 0 ? 1 : -1;
    switches.push_back((first ? left : right) * Jet{sign});
  }

  Table table_;
  std::vector<double> slope_;
};

}  // namespace

std::shared_ptr<const Function> function_of(Table table) { return std::make_shared<FunctionOfTable>(std::move(table)); }

}  // namespace floe::math
