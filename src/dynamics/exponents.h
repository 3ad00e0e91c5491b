#pragma once
#include <Eigen/Core>
#include <complex>
#include <vector>

/// Exponents s of (s^2 M + s C + K) y = 0.
namespace floe::dynamics {

struct Quadratic {
  Eigen::MatrixXd M, C, K;
};

using Exponents = std::vector<std::complex<double>>;

/// Those of which inverse iteration, s^2 y'My + s y'Cy + y'Ky = 0 from y <- (s^2 M + s C + K)^-1 M y, stays within a
/// per cent, each as it comes out of that. Only those are asked that grow or decay by more than `small` and 1e-7 |s|:
/// round-off of a linearisation makes such of fast vibrations, s = +-iw.
Exponents confirmed(const Quadratic& problem, const Exponents& found, double small);

}  // namespace floe::dynamics
