#pragma once
#include <array>
#include <span>
#include <vector>

#include "floe/math/formula.h"

namespace floe::math {

/// Where a formula may have a kink, a jump or an end: times of both sides, round-off apart, with f, f' and f'' there.
struct Break {
  double before = 0, after = 0;
  std::array<double, 3> left{}, right{};
};

/// All of an interval, and how large f, f' and f'' are: the maximum finite values at the samples.
struct Breaks {
  std::vector<Break> at;  ///< ascending
  std::array<double, 3> size{};
};

/// Where one of the formula's switches (a condition, the argument of abs or sqrt, t - from of a ramp, ...) changes its
/// sign or touches zero, as a function of the first variable; whether f jumps there, left and right tell.
///
/// Samples `spacing` apart, at most 100,000, and where switches that are linear in time vanish, however near to one
/// another; then bisection to neighbouring numbers, so that neither `to` nor the spacing changes what is found. Other
/// switches that vanish twice between two samples are not seen. None of a formula without derivatives (Formula).
/// @param from, to  from >= 0 and finite;  @param spacing  > 0
/// @param others  constant values of the variables behind the first one; 1 where none is given
Breaks breaks(const Formula& formula, double from, double to, double spacing, std::span<const double> others = {});

}  // namespace floe::math
