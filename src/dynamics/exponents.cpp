#include "exponents.h"

#include <Eigen/LU>
#include <cmath>

namespace floe::dynamics {
namespace {

using Complex = std::complex<double>;

/// The root of a s^2 + b s + c = 0 that is nearest to s.
Complex nearest_root(Complex a, Complex b, Complex c, Complex s) {
  const Complex root = std::sqrt(b * b - 4.0 * a * c), one = (-b + root) / (2.0 * a), other = (-b - root) / (2.0 * a);
  return std::abs(one - s) < std::abs(other - s) ? one : other;
}

Complex refined(const Quadratic& problem, const Complex start) {
  constexpr int most = 6;
  const Eigen::Index n = problem.M.rows();
  Eigen::VectorXcd y(n);
  for (Eigen::Index i = 0; i < n; ++i)
    y[i] = {std::sin(1 + 1.7 * static_cast<double>(i)), std::cos(2.3 * static_cast<double>(i))};
  Complex s = start;
  for (int i = 0; i < most; ++i) {
    const Eigen::MatrixXcd Q = s * s * problem.M + s * problem.C + problem.K;
    const Eigen::VectorXcd next = Q.partialPivLu().solve(problem.M * y);
    if (!next.allFinite()) return s;  // s is one to the last digit
    y = next.normalized();
    const Complex before = s;
    s = nearest_root(y.dot(problem.M * y), y.dot(problem.C * y), y.dot(problem.K * y), s);
    if (!(std::abs(s - before) > 1e-9 * std::abs(s)) && i > 0) break;
  }
  return s;
}

}  // namespace

Exponents confirmed(const Quadratic& problem, const Exponents& found, double small) {
  Exponents all;
  for (const Complex& s : found) {
    const double size = std::abs(s);
    if (!std::isfinite(size)) continue;
    if (!(std::abs(s.real()) > small + 1e-7 * size)) {
      all.push_back(s);
      continue;
    }
    const Complex exact = refined(problem, s);
    if (std::abs(exact - s) <= 1e-2 * size) all.push_back(exact);
  }
  return all;
}

}  // namespace floe::dynamics
