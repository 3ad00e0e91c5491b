#pragma once
#include <cmath>

namespace floe::math {

/// A value with its first two derivatives by one variable.
struct Jet {
  double value = 0, first = 0, second = 0;
  bool constant() const { return first == 0 && second == 0; }
};

/// f(x) by the chain rule. Derivatives of f are not looked at where x does not vary: there they may be infinite.
inline Jet chain(const Jet& x, double f, double df, double ddf) {
  if (x.constant()) return {f};
  return {f, df * x.first, (x.first == 0 ? 0 : ddf * x.first * x.first) + df * x.second};
}

inline Jet operator+(const Jet& a, const Jet& b) { return {a.value + b.value, a.first + b.first, a.second + b.second}; }
inline Jet operator-(const Jet& a) { return {-a.value, -a.first, -a.second}; }
inline Jet operator-(const Jet& a, const Jet& b) { return a + -b; }
inline Jet operator*(const Jet& a, const Jet& b) {
  return {a.value * b.value, a.first * b.value + a.value * b.first,
          a.second * b.value + 2 * a.first * b.first + a.value * b.second};
}
inline Jet operator/(const Jet& a, const Jet& b) {
  const double r = 1 / b.value;
  Jet quotient = a * chain(b, r, -r * r, 2 * r * r * r);
  quotient.value = a.value / b.value;
  return quotient;
}

/// x^y; with a constant exponent also at x = 0, where the logarithm is infinite.
inline Jet power(const Jet& x, const Jet& y) {
  const double p = std::pow(x.value, y.value);
  if (y.constant()) {
    const double c = y.value;
    return chain(x, p, c == 0 ? 0 : c * std::pow(x.value, c - 1),
                 c == 0 || c == 1 ? 0 : c * (c - 1) * std::pow(x.value, c - 2));
  }
  const Jet exponent = y * chain(x, std::log(x.value), 1 / x.value, -1 / (x.value * x.value));
  return chain(exponent, p, p, p);
}

}  // namespace floe::math
