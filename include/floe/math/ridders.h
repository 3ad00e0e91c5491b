#pragma once
#include <array>
#include <cmath>
#include <limits>

namespace floe::math {

/// Limit h -> 0 of an even function of the step h, as central differences are: D(h) = D + a h^2 + b h^4 + ...
///
/// Halves h and extrapolates (Neville); returns the entry of the tableau that agrees best with its two neighbours, so
/// that neither truncation at large steps nor cancellation at small ones decides. Stops as soon as they agree to 1e-12.
/// Source: Ridders 1982, Accurate computation of F'(x) and F'(x)F''(x).
template <class Difference>
double ridders_limit(const Difference& difference, double first_step) {
  constexpr int levels = 14;
  std::array<double, levels> previous{}, row{};
  double best = 0, least = std::numeric_limits<double>::infinity(), h = first_step;
  for (int i = 0; i < levels; ++i, h /= 2) {
    row[0] = difference(h);
    double power = 1;
    for (int j = 1; j <= i; ++j) {
      power *= 4;
      row[j] = (power * row[j - 1] - previous[j - 1]) / (power - 1);
      const double error = std::max(std::abs(row[j] - row[j - 1]), std::abs(row[j] - previous[j - 1]));
      if (error < least) least = error, best = row[j];
    }
    if (i > 1 && least <= 1e-12 * std::abs(best)) break;
    previous = row;
  }
  return best;
}

}  // namespace floe::math
