#include "floe/dynamics/patched_function.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace floe::dynamics {

double Patch::derivative(int order, double t) const {
  const double h = end - begin, s = (t - begin) / h;
  double sum = 0;
  for (int k = 4; k >= order; --k) sum = sum * s + coefficients[k] * (order == 0 ? 1 : order == 1 ? k : k * (k - 1));
  return sum / std::pow(h, order);
}

TimeFunction patched(TimeFunction function, std::vector<Patch> patches, double begin) {
  const auto with = [patches = std::move(patches), begin](std::function<double(double)> f, int order) {
    return [patches, begin, f = std::move(f), order](double t) {
      t = std::max(t, begin);
      const auto patch = std::find_if(patches.begin(), patches.end(),
                                      [&](const Patch& one) { return one.begin <= t && t <= one.end; });
      return patch != patches.end() ? patch->derivative(order, t) : f(t);
    };
  };
  return {with(std::move(function.value), 0), with(std::move(function.rate), 1),
          with(std::move(function.acceleration), 2)};
}

}  // namespace floe::dynamics
