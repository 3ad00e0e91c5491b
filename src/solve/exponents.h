#pragma once
#include <Eigen/Core>
#include <complex>
#include <vector>

#include "floe/solve/steady_rotation.h"

namespace floe::solve {

/// (s^2 M + s C + K) y = 0 of real square matrices.
struct Quadratic {
  Eigen::MatrixXd M, C, K;
};

using Exponents = std::vector<std::complex<double>>;

/// An exponent by two-sided iteration from one that is nearly one,
///
///   Q(s) = s^2 M + s C + K,   y <- Q^-1 Q' y,   z <- Q^-H Q'^H z,   s <- s - z'Q y / z'Q'y
///
/// and what round-off of the matrices may make of it, |ds| = 4 eps (|s|^2 |M| + |s| |C| + |K|) |z| |y| / |z'Q'y|. A
/// real one stays real.
struct Refined {
  std::complex<double> s;
  double uncertainty;
};
Refined refined(const Quadratic& problem, std::complex<double> start);

/// The `count` slowest vibrations of the exponents `found` by |s|, and all that grow besides; one for each pair s = a
/// +- ib. Of real ones, half as many as there are: those that grow most or decay least. In the order of their
/// frequencies.
///
/// A linearisation's round-off makes fast vibrations grow or decay, and at times real exponents of nothing. What grows
/// or decays is refined: where that leads away (by a per cent; of real ones that round-off may make, by 1e-6) there is
/// no exponent, and growth that round-off may make is none.
/// @param nothing  exponents that are not distinguished from zero, |s| <= nothing: frames that rotate or drift freely
/// @param small    growth that is none; in addition to 1e-7 |s|
std::vector<Vibration> slowest_vibrations(const Quadratic& problem, const Exponents& found, double nothing,
                                          double small, int count);

/// The eigenvectors y of vibrations that oscillate, y^H M y = 1, by inverse iteration, y <- Q(s)^-1 Q'(s) y; those of
/// exponents that coincide are orthogonal to one another in M. Others' columns are zero. n x number of vibrations
Eigen::MatrixXcd shapes(const Quadratic& problem, const std::vector<Vibration>& vibrations);
/// The same from eigenvectors that are known, each of the nearest exponent.
Eigen::MatrixXcd shapes(const Quadratic& problem, const std::vector<Vibration>& vibrations, const Exponents& found,
                        const Eigen::MatrixXcd& vectors);

}  // namespace floe::solve
