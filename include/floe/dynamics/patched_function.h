#pragma once
#include <Eigen/Dense>
#include <vector>

#include "floe/dynamics/time_function.h"

namespace floe::dynamics {

/// A polynomial of fourth degree in (t - begin) / (end - begin).
struct Patch {
  double begin, end;  ///< [s]
  Eigen::Matrix<double, 5, 1> coefficients;

  /// A derivative by t, 0 to 2.
  double derivative(int order, double t) const;
};

/// The function with patches in its place where there are some; before `begin` it is what it is there.
TimeFunction patched(TimeFunction function, std::vector<Patch> patches, double begin);

}  // namespace floe::dynamics
