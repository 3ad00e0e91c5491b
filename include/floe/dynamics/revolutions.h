#pragma once
#include <span>
#include <vector>

namespace floe::dynamics {

/// Which of the angles x + 2 pi k a configuration has: the one nearest to that expected from the last step's beginning,
///
///   x(t) = x_0 + x_0' (t - t_0),
///
/// so that a step may contain any number of revolutions, as long as the rate changes by less than half a revolution per
/// step within it. Beginnings of steps, which may lie further apart (the states of an estimate), are joined by the mean
/// of their rates.
class Revolutions {
 public:
  explicit Revolutions(double angle = 0) : angle_(angle) {}
  /// The expected angle within a step [rad].
  double expected(double t) const { return angle_ + rate_ * (t - t_); }
  /// The expected angle at a step's beginning, where the rate is known.
  double expected(double t, double rate) const { return angle_ + 0.5 * (rate_ + rate) * (t - t_); }
  /// A step begins.
  void begin(double t, double angle, double rate) { t_ = t, angle_ = angle, rate_ = rate; }
  void save(std::vector<double>& numbers) const { numbers.insert(numbers.end(), {t_, angle_, rate_}); }
  /// @return what follows
  std::span<const double> load(std::span<const double> numbers) {
    begin(numbers[0], numbers[1], numbers[2]);
    return numbers.subspan(3);
  }

 private:
  double t_ = 0, angle_, rate_ = 0;
};

}  // namespace floe::dynamics
