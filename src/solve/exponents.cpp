#include "exponents.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace floe::solve {
namespace {

using Complex = std::complex<double>;

/// Entries that no eigenvector is normal to.
template <class Scalar>
Eigen::Vector<Scalar, Eigen::Dynamic> start_vector(Eigen::Index n) {
  Eigen::Vector<Scalar, Eigen::Dynamic> y(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto x = static_cast<double>(i);
    if constexpr (std::is_same_v<Scalar, Complex>)
      y[i] = {std::sin(1 + 1.7 * x), std::cos(2.3 * x)};
    else
      y[i] = std::sin(1 + 1.7 * x);
  }
  return y;
}

template <class Scalar>
Refined iterate(const Quadratic& problem, const Scalar start) {
  using Matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;
  constexpr int most = 12;
  const double eps = std::numeric_limits<double>::epsilon();
  const double M = problem.M.norm(), C = problem.C.norm(), K = problem.K.norm();
  auto y = start_vector<Scalar>(problem.M.rows()), z = y;
  Scalar s = start;
  Refined best{s, std::numeric_limits<double>::infinity()};
  double last = std::numeric_limits<double>::infinity();
  for (int i = 0; i < most; ++i) {
    const Matrix Q = s * s * problem.M + s * problem.C + problem.K, slope = 2.0 * s * problem.M + problem.C;
    const Eigen::PartialPivLU<Matrix> factor(Q);
    if (i == 0) {  // what is slow in both comes first, whatever the starts
      y = factor.solve(y).normalized();
      z = factor.adjoint().solve(z).normalized();
    }
    const Eigen::Vector<Scalar, Eigen::Dynamic> right = factor.solve(slope * y).normalized(),
                                                left = factor.adjoint().solve(slope.adjoint() * z).normalized();
    if (!right.allFinite() || !left.allFinite()) return best;  // s is one to the last digit
    y = right, z = left;
    const Scalar change = z.dot(Q * y), rate = z.dot(slope * y);
    const double size = std::abs(s);
    if (!(std::abs(rate) > 0)) return best;
    const double uncertainty = 4 * eps * (size * size * M + size * C + K) / std::abs(rate);
    const double step = std::abs(change / rate);
    s -= change / rate;
    best = {s, uncertainty};
    if (step <= std::max(1e-13 * std::abs(s), 1e-3 * uncertainty) || (i > 2 && step >= 0.5 * last)) break;
    last = step;
  }
  return best;
}

/// The exponent that `s` stands for; nothing where there is none. The bound of round-off takes the greatest entries for
/// all, which is far too much where stiffness spreads: what two ways of computing agree in is not round-off.
std::optional<Complex> confirmed(const Quadratic& problem, const Complex s, double small) {
  const double size = std::abs(s);
  const bool real = s.imag() == 0;
  const auto none = [&](double growth) { return !real && std::abs(growth) <= small + 1e-7 * size; };
  if (none(s.real())) return Complex(0, s.imag());
  const auto [exact, uncertainty] = refined(problem, s);
  const double moved = std::abs(exact - s), growth = std::abs(exact.real());
  if (!(moved <= 1e-2 * size) || (real && uncertainty > growth && moved > 1e-6 * size)) return {};
  const bool agreed = growth > uncertainty || std::abs(exact.real() - s.real()) <= 0.1 * growth;
  return none(exact.real()) || (!real && !agreed) ? Complex(0, exact.imag()) : exact;
}

bool is_overdamped(const Vibration& one) { return one.omega == 0 && !one.zero && one.growth < 0; }

}  // namespace

Refined refined(const Quadratic& problem, const Complex start) {
  return start.imag() == 0 ? iterate(problem, start.real()) : iterate(problem, start);
}

namespace {

Complex exponent_of(const Vibration& one) { return {one.growth, one.omega}; }

/// y^H M y = 1.
Eigen::VectorXcd of_unit_mass(const Quadratic& problem, const Eigen::VectorXcd& y) {
  return y / std::sqrt(std::abs(y.dot(problem.M * y)));
}

}  // namespace

Eigen::MatrixXcd shapes(const Quadratic& problem, const std::vector<Vibration>& vibrations, const Exponents& found,
                        const Eigen::MatrixXcd& vectors) {
  Eigen::MatrixXcd all = Eigen::MatrixXcd::Zero(problem.M.rows(), static_cast<Eigen::Index>(vibrations.size()));
  std::vector<char> taken(found.size());
  for (std::size_t i = 0; i < vibrations.size(); ++i) {
    const Complex s = exponent_of(vibrations[i]);
    std::optional<std::size_t> nearest;
    for (std::size_t j = 0; j < found.size(); ++j)
      if (!taken[j] && (!nearest || std::abs(found[j] - s) < std::abs(found[*nearest] - s))) nearest = j;
    if (s.imag() == 0 || !nearest) continue;
    taken[*nearest] = 1;
    all.col(static_cast<Eigen::Index>(i)) = of_unit_mass(problem, vectors.col(static_cast<Eigen::Index>(*nearest)));
  }
  return all;
}

Eigen::MatrixXcd shapes(const Quadratic& problem, const std::vector<Vibration>& vibrations) {
  const Eigen::Index n = problem.M.rows();
  Eigen::MatrixXcd all = Eigen::MatrixXcd::Zero(n, static_cast<Eigen::Index>(vibrations.size()));
  const auto exponent = [&](Eigen::Index i) { return exponent_of(vibrations[static_cast<std::size_t>(i)]); };
  for (Eigen::Index i = 0; i < all.cols(); ++i) {
    const Complex s = exponent(i);
    if (s.imag() == 0) continue;
    const Complex beside = s * (1 + 1e-9);  // Q(s) itself is singular
    const Eigen::MatrixXcd slope = 2.0 * beside * problem.M + problem.C;
    const Eigen::PartialPivLU<Eigen::MatrixXcd> factor(beside * beside * problem.M + beside * problem.C + problem.K);
    Eigen::VectorXcd y = start_vector<Complex>(n);
    for (int sweep = 0; sweep < 3; ++sweep) {
      y = factor.solve(slope * y);
      for (Eigen::Index j = 0; j < i; ++j)
        if (std::abs(exponent(j) - s) <= 1e-6 * std::abs(s)) y -= all.col(j) * all.col(j).dot(problem.M * y);
      y = of_unit_mass(problem, y);
    }
    if (y.allFinite()) all.col(i) = y;
  }
  return all;
}

double modal_assurance(const Vibration& one, const Vibration& other) {
  if (one.shape.size() == 0 || one.shape.size() != other.shape.size()) return 0;
  return std::norm((one.shape.dot(other.momentum) + one.momentum.dot(other.shape)) / 2.0);
}

std::vector<Vibration> slowest_vibrations(const Quadratic& problem, const Exponents& found, double nothing,
                                          double small, int count) {
  const auto wanted = static_cast<std::size_t>(count);
  std::vector<Vibration> all;
  std::vector<double> real;
  Exponents swings;
  std::size_t zeros = 0;
  for (const Complex& s : found) {
    const double size = std::abs(s);
    if (!std::isfinite(size)) continue;
    if (size <= nothing) {
      ++zeros;
    } else if (std::abs(s.imag()) <= 1e-9 * size) {
      if (const auto exact = confirmed(problem, s.real(), 0)) real.push_back(exact->real());
    } else if (s.real() < 0 && std::abs(s.imag()) <= 1e-4 * size) {
      real.push_back(s.real());  // a double root to round-off, and no vibration within 5e-9 of critical damping
    } else if (s.imag() > 0) {
      swings.push_back(s);
    }
  }
  for (std::size_t i = 0; 2 * i < zeros; ++i) all.push_back({0, 0, true, nothing});
  std::sort(real.rbegin(), real.rend());
  for (std::size_t i = 0; i < real.size() && (2 * i < real.size() || real[i] > 0); ++i) all.push_back({0, real[i]});
  const auto size_of = [](const Vibration& one) { return std::hypot(one.omega, one.growth); };
  const auto before = [&](double size) {  // how many are slower
    return static_cast<std::size_t>(std::count_if(
        all.begin(), all.end(), [&](const Vibration& one) { return size_of(one) < size && !is_overdamped(one); }));
  };
  std::sort(swings.begin(), swings.end(), [](const Complex& a, const Complex& b) { return std::abs(a) < std::abs(b); });
  for (const Complex& s : swings) {
    if (s.real() <= small + 1e-7 * std::abs(s) && before(0.98 * std::abs(s)) >= wanted) continue;
    if (const auto exact = confirmed(problem, s, small)) all.push_back({std::abs(exact->imag()), exact->real()});
  }
  // the slowest, and whatever grows
  std::stable_sort(all.begin(), all.end(),
                   [&](const Vibration& a, const Vibration& b) { return size_of(a) < size_of(b); });
  std::vector<Vibration> chosen;  // overdamped motions besides: they are no vibrations
  std::size_t vibrations = 0;
  for (const Vibration& one : all)
    if (vibrations < wanted || one.unstable()) chosen.push_back(one), vibrations += is_overdamped(one) ? 0 : 1;
  std::sort(chosen.begin(), chosen.end(), [](const Vibration& a, const Vibration& b) {
    return a.omega != b.omega ? a.omega < b.omega : a.growth > b.growth;
  });
  return chosen;
}

}  // namespace floe::solve
