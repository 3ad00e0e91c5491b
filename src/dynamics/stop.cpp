#include "floe/dynamics/stop.h"

#include <algorithm>

namespace floe::dynamics {

ForceOnCoordinate StopLaw::at(double x, double rate) const {
  const double sign = x > upper ? 1 : x < lower ? -1 : 0;
  if (sign == 0) return {};
  const double d = sign > 0 ? x - upper : lower - x, s = std::min(d / width, 1.0);
  const double spring = d < width ? stiffness * d * s / 2 : stiffness * (d - width / 2);
  const double share = s * s * (3 - 2 * s), share_by_d = d < width ? 6 * s * (1 - s) / width : 0;
  const double energy = d < width ? stiffness * d * d * s / 6 : stiffness * (d * (d - width) / 2 + width * width / 6);
  return {sign * spring + damping * share * rate, stiffness * s + sign * damping * share_by_d * rate, damping * share,
          energy};
}

}  // namespace floe::dynamics
