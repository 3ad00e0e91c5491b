#include "functions.h"

#include <algorithm>
#include <numbers>

namespace floe::math {
namespace {

/// A function of one argument with its derivatives.
Operation of_one(double (*f)(double), double (*df)(double), double (*ddf)(double)) {
  return [=](Arguments a) {
    const double x = a[0].value;
    return a[0].constant() ? Jet{f(x)} : chain(a[0], f(x), df(x), ddf(x));
  };
}

double zero(double) { return 0; }

/// A function that is constant in pieces.
Operation steps(double (*f)(double)) { return of_one(f, zero, zero); }

Jet extreme(Arguments a, bool greatest) {
  const auto less = [](const Jet& one, const Jet& two) { return one.value < two.value; };
  return greatest ? *std::max_element(a.begin(), a.end(), less) : *std::min_element(a.begin(), a.end(), less);
}

Jet sum(Arguments a) {
  Jet s;
  for (const Jet& term : a) s = s + term;
  return s;
}

/// Of functions with a kink or a jump at 0.
void by_value(Arguments a, std::vector<Jet>& switches) { switches.push_back(a[0]); }

/// Of those with an end at 0: also where the argument touches 0.
void by_sign(Arguments a, std::vector<Jet>& switches) {
  switches.push_back(a[0]);
  switches.push_back({a[0].first, a[0].second, 0});
}

/// Of ramp and pulse.
void between_two(Arguments a, std::vector<Jet>& switches) {
  switches.insert(switches.end(), {a[0] - a[1], a[0] - a[2]});
}

/// Of min and max: each pair.
void by_order(Arguments a, std::vector<Jet>& switches) {
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t j = i + 1; j < a.size(); ++j) switches.push_back(a[i] - a[j]);
}

/// Of asin and the like, which end at -1 and 1.
void by_ends(Arguments a, std::vector<Jet>& switches) {
  switches.push_back(Jet{1} - a[0] * a[0]);
  switches.push_back({a[0].first, a[0].second, 0});
}

}  // namespace

void power_switches(Arguments a, std::vector<Jet>& switches) {
  if (!a[1].constant() || a[1].value < 0 || a[1].value != std::floor(a[1].value)) by_sign(a, switches);
}

const std::map<std::string, KnownFunction>& known_functions() {
  using D = double;
  static const std::map<std::string, KnownFunction> all{
      {"sin", {of_one(std::sin, std::cos, [](D x) { return -std::sin(x); })}},
      {"cos",
       {of_one(
           std::cos, [](D x) { return -std::sin(x); }, [](D x) { return -std::cos(x); })}},
      {"tan",
       {of_one(
           std::tan, [](D x) { return 1 + std::pow(std::tan(x), 2); },
           [](D x) { return 2 * std::tan(x) * (1 + std::pow(std::tan(x), 2)); })}},
      {"asin",
       {of_one(
            std::asin, [](D x) { return 1 / std::sqrt(1 - x * x); }, [](D x) { return x / std::pow(1 - x * x, 1.5); }),
        1, by_ends}},
      {"acos",
       {of_one(
            std::acos, [](D x) { return -1 / std::sqrt(1 - x * x); },
            [](D x) { return -x / std::pow(1 - x * x, 1.5); }),
        1, by_ends}},
      {"atan",
       {of_one(
           std::atan, [](D x) { return 1 / (1 + x * x); }, [](D x) { return -2 * x / std::pow(1 + x * x, 2); })}},
      {"sinh", {of_one(std::sinh, std::cosh, std::sinh)}},
      {"cosh", {of_one(std::cosh, std::sinh, std::cosh)}},
      {"tanh",
       {of_one(
           std::tanh, [](D x) { return 1 - std::pow(std::tanh(x), 2); },
           [](D x) { return -2 * std::tanh(x) * (1 - std::pow(std::tanh(x), 2)); })}},
      {"asinh",
       {of_one(
           std::asinh, [](D x) { return 1 / std::sqrt(1 + x * x); },
           [](D x) { return -x / std::pow(1 + x * x, 1.5); })}},
      {"acosh",
       {of_one(
           std::acosh, [](D x) { return 1 / std::sqrt(x * x - 1); },
           [](D x) { return -x / std::pow(x * x - 1, 1.5); })}},
      {"atanh",
       {of_one(
           std::atanh, [](D x) { return 1 / (1 - x * x); }, [](D x) { return 2 * x / std::pow(1 - x * x, 2); })}},
      {"exp", {of_one(std::exp, std::exp, std::exp)}},
      {"ln",
       {of_one(
           std::log, [](D x) { return 1 / x; }, [](D x) { return -1 / (x * x); })}},
      {"log",
       {of_one(
           std::log, [](D x) { return 1 / x; }, [](D x) { return -1 / (x * x); })}},
      {"log2",
       {of_one(
           std::log2, [](D x) { return std::numbers::log2e / x; },
           [](D x) { return -std::numbers::log2e / (x * x); })}},
      {"log10",
       {of_one(
           std::log10, [](D x) { return std::numbers::log10e / x; },
           [](D x) { return -std::numbers::log10e / (x * x); })}},
      {"sqrt",
       {of_one(
            std::sqrt, [](D x) { return 0.5 / std::sqrt(x); }, [](D x) { return -0.25 / (x * std::sqrt(x)); }),
        1, by_sign}},
      {"abs",
       {of_one(
            std::fabs, [](D x) { return x < 0   ? -1.0
                                        : x > 0 ? 1.0
                                                : 0.0; }, zero),
        1, by_value}},
      {"sign", {steps([](D x) { return x < 0   ? -1.0
                                       : x > 0 ? 1.0
                                               : 0.0; }), 1, by_value}},
      {"rint",
       {steps([](D x) { return std::floor(x + 0.5); }), 1,
        [](Arguments a, std::vector<Jet>& switches) {  // x = k + 1/2
          const double y = std::numbers::pi * a[0].value;
          switches.push_back(chain(a[0], std::cos(y), -std::numbers::pi * std::sin(y), 0));
        }}},
      {"atan2",
       {[](Arguments a) {
          Jet angle = Jet{std::atan2(a[0].value, a[1].value)};
          const Jet square = a[0] * a[0] + a[1] * a[1];
          const Jet &y = a[0], &x = a[1];
          // (x y' - y x') / (x^2 + y^2), and its derivative
          const double top = x.value * y.first - y.value * x.first, change = x.value * y.second - y.value * x.second;
          if (y.constant() && x.constant()) return angle;
          angle.first = top / square.value;
          angle.second = (change - angle.first * square.first) / square.value;
          return angle;
        },
        2,
        [](Arguments a, std::vector<Jet>& switches) {  // the cut along the negative axis
          switches.push_back(a[1]);
          if (a[1].value < 0) switches.push_back(a[0]);
        }}},
      {"min", {[](Arguments a) { return extreme(a, false); }, 0, by_order}},
      {"max", {[](Arguments a) { return extreme(a, true); }, 0, by_order}},
      {"sum", {sum, 0}},
      {"avg", {[](Arguments a) { return sum(a) / Jet{static_cast<double>(a.size())}; }, 0}},
      {"triangle",
       {[](Arguments a) {
          const Jet &t = a[0], &rise = a[1], &fall = a[2];
          if (t.value < 0 || t.value >= rise.value + fall.value || (t.value == 0 && rise.value == 0)) return Jet{};
          return t.value < rise.value ? t / rise : (rise + fall - t) / fall;
        },
        3,
        [](Arguments a, std::vector<Jet>& switches) {
          switches.insert(switches.end(), {a[0], a[0] - a[1], a[0] - a[1] - a[2]});
        }}},
      {"ramp",
       {[](Arguments a) {
          if (a[0].value < a[1].value || (a[0].value == a[1].value && a[1].value == a[2].value)) return Jet{0};
          if (a[0].value >= a[2].value) return Jet{1};
          return (a[0] - a[1]) / (a[2] - a[1]);
        },
        3, between_two}},
      {"smooth",
       {[](Arguments a) {  // 6 x^5 - 15 x^4 + 10 x^3
          if (a[0].value <= a[1].value) return Jet{0};
          if (a[0].value >= a[2].value) return Jet{1};
          const Jet x = (a[0] - a[1]) / (a[2] - a[1]);
          return x * x * x * (x * (x * Jet{6} - Jet{15}) + Jet{10});
        },
        3,
        [](Arguments a, std::vector<Jet>& switches) {  // a jump, where it takes no time
          if (!(a[1].value < a[2].value)) switches.push_back(a[0] - a[1]);
        }}},
      {"pulse",
       {[](Arguments a) { return Jet{a[1].value <= a[0].value && a[0].value < a[2].value ? 1.0 : 0.0}; }, 3,
        between_two}},
  };
  return all;
}  // NOLINT(clang-analyzer-cplusplus.NewDeleteLeaks): they are static

}  // namespace floe::math
