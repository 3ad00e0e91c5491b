#pragma once
#include <functional>

#include "floe/dynamics/term.h"

namespace floe::dynamics {

/// A function of time with its first two derivatives.
struct TimeFunction {
  std::function<double(double)> value, rate, acceleration;
};

/// The derivative of f that a constraint needs at a level; 0 of an empty function.
inline double at_level(ConstraintLevel level, const TimeFunction& f, double t) {
  if (!f.value) return 0;
  return level == ConstraintLevel::position   ? f.value(t)
         : level == ConstraintLevel::velocity ? f.rate(t)
                                              : f.acceleration(t);
}

}  // namespace floe::dynamics
