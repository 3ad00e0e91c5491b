#include "floe/math/formula.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

using Catch::Matchers::Contains;
using floe::math::Formula;
using floe::math::FormulaError;

namespace {
const std::vector<std::string> of_t{"t"};
double value(const std::string& text, double t = 0) { return Formula(text, of_t, {{"F", 2500.0}, {"L", 100.0}})(t); }
std::string complaint(const std::string& text) {
  try {
    value(text);
  } catch (const FormulaError& error) {
    return error.what();
  }
  return "";
}
}  // namespace

TEST_CASE("a formula has the value of its C++ twin") {
  CHECK(value("F*sin(9.5*t)", 0.3) == 2500 * std::sin(9.5 * 0.3));
  CHECK(value("t<2.5 ? 32*t : 160-32*t", 1) == 32);
  CHECK(value("t<2.5 ? 32*t : 160-32*t", 4) == 32);
  CHECK(value("pi/2 + e") == Approx(M_PI / 2 + M_E).epsilon(1e-15));
  CHECK(value("-1.5e-3*L") == -0.15);
  CHECK(value("2e+1") == 20);
  CHECK(Formula("x - 2*y", {"x", "y"}, {})(5, 1) == 3);
}

TEST_CASE("triangle, ramp and pulse are what their definitions say") {
  CHECK(value("80*triangle(t, 2.5, 2.5)", 1.25) == 40);
  CHECK(value("triangle(t, 1, 3)", 2.5) == 0.5);
  CHECK(value("triangle(t, 1, 3)", 1) == 1);
  CHECK(value("triangle(t, 0, 1)", 0.25) == 0.75);
  CHECK(value("triangle(t, 1, 3)", -1) == 0);
  CHECK(value("triangle(t, 1, 3)", 4) == 0);
  CHECK(value("ramp(t, 1, 3)", 1.5) == 0.25);
  CHECK(value("ramp(t, 1, 1)", 1) == 0);
  CHECK(value("ramp(t, 1, 1)", 1.1) == 1);
  CHECK(value("pulse(t, 1, 2)", 1) == 1);
  CHECK(value("pulse(t, 1, 2)", 2) == 0);
}

TEST_CASE("a number is a formula, and constants know that they are constant") {
  CHECK(Formula(4.5)(7) == 4.5);
  CHECK(Formula()() == 0);
  CHECK(Formula("2*L", of_t, {{"L", 3}}).constant());
  CHECK_FALSE(Formula("2*t", of_t, {}).constant());
  CHECK(Formula("2*t", of_t, {}).text() == "2*t");
  CHECK(Formula("2*L", of_t, {{"L", 3}}).derivative(1) == 0);
}

TEST_CASE("copies share their tree and disturb each other's values not") {
  const Formula a("t^2", of_t, {}), b = a;
  CHECK(a(3) == 9);
  CHECK(b(4) == 16);
  CHECK(a(3) == 9);
}

TEST_CASE("what is wrong with a formula is said") {
  CHECK_THAT(complaint("2*(t"), Contains("does not parse"));
  CHECK_THAT(complaint(""), Contains("does not parse"));
  CHECK_THAT(complaint("G*sinn(t)"), Contains("\"G\" at character 1"));
  CHECK_THAT(complaint("F*sinn(t)"), Contains("\"sinn\" at character 3"));
  CHECK_THAT(complaint("1, 2"), Contains("more than one formula"));
  CHECK_THAT(complaint("t=3"), Contains("assigns at character 2"));
  CHECK_THAT(complaint("sin(1, 2)"), Contains("sin has 1 arguments, not 2"));
  CHECK_THAT(complaint("sin + 1"), Contains("unexpected \"+\" at character 5"));
  CHECK_THAT(complaint("2t"), Contains("unexpected \"t\" at character 2"));
  CHECK_THAT(complaint("0x10"), Contains("unexpected \"x\""));
  CHECK_THAT(complaint("t > 1 ? 2"), Contains("missing \":\""));
  CHECK_THAT(complaint("1/0"), Contains("infinite"));
  CHECK_THAT(complaint("sqrt(t-1)"), Contains("not a number at t = 0"));
  CHECK_THAT(complaint("log(0*t-1)"), Contains("not a number"));
  CHECK(complaint("t>=0 && t!=1 && t<=4 ? 1 : 2").empty());
  try {
    value("F*cosinus(t)");
    FAIL("cosinus is no function");
  } catch (const FormulaError& error) {
    CHECK(error.unknown == "cosinus");
  }
}

TEST_CASE("derivatives agree with the closed form over scales of time") {
  for (const double w : {1e-6, 0.01, 1.0, 9.5, 150.0, 5000.0, 200 * M_PI, 1e6, 1e9}) {
    for (const double t : {0.0, 0.013, 1.7, 40.0}) {
      const Formula f("sin(w*t)", of_t, {{"w", w}});
      INFO("w = " << w << ", t = " << t);
      CHECK(std::abs(f.derivative(t) - w * std::cos(w * t)) < 1e-14 * w);
      CHECK(std::abs(f.second_derivative(t) + w * w * std::sin(w * t)) < 1e-14 * w * w);
    }
  }
  CHECK(Formula("150*t", of_t, {}).derivative(0.03) == Approx(150).epsilon(1e-12));
  CHECK(Formula("x*y^3", {"x", "y"}, {}).derivative(2, 3) == Approx(27).epsilon(1e-12));
}

TEST_CASE("derivatives exist where a formula begins") {
  const Formula f("t^2.5", of_t, {});
  CHECK(f.derivative(0) == 0);
  CHECK(f.second_derivative(0) == 0);
  CHECK(f.second_derivative(4) == Approx(3.75 * 2));
  CHECK(Formula("t*sqrt(t)", of_t, {}).derivative(0.25) == Approx(0.75));
  CHECK_THROWS_WITH(Formula("sqrt(t)", of_t, {}).derivative(0),
                    Catch::Contains("the derivative of \"sqrt(t)\" is infinite at t = 0"));
}

TEST_CASE("derivatives are those of the branch that is taken") {
  CHECK(Formula("t < 0.1 ? 0 : (t - 0.1)^3", of_t, {}).second_derivative(0.1) == 0);
  CHECK(Formula("t < 0.1 ? 0 : (t - 0.1)^3", of_t, {}).derivative(0.2) == Approx(0.03));
  CHECK(Formula("ramp(t, 0, 2)", of_t, {}).derivative(0) == 0.5);
  CHECK(Formula("max(0, t - 1)", of_t, {}).derivative(3) == 1);
  CHECK(Formula("pulse(t, 0, 1)", of_t, {}).derivative(0.5) == 0);
  CHECK(Formula("triangle(t, 2, 4)", of_t, {}).derivative(3) == -0.25);
}

TEST_CASE("derivatives of every function and operator agree with differences") {
  std::vector<std::string> texts{"-t^2",
                                 "2^-t",
                                 "t^t",
                                 "2^t^2",
                                 "1/t/2 - t - 1",
                                 "t*-2",
                                 "+t*2",
                                 "3*t > 1 && t < 2 ? t*t : -t",
                                 "t >= 1 || t != 1 ? t^3 : 1",
                                 "t <= 2 == 1 ? 1e-1*t : .5",
                                 "(t > 5 ? 1 : t > 0.2 ? t^2 : 0)"};
  const std::map<std::string, std::string> arguments{
      {"atan2", "(t, 2 - t)"}, {"acosh", "(1 + t)"},       {"min", "(t, 3*t, 1 + t)"}, {"max", "(t, 3*t)"},
      {"sum", "(t, t^2, 1)"},  {"avg", "(t, t^2, 1)"},     {"triangle", "(t, 1, 2)"},  {"ramp", "(t, 0.1, t + 2)"},
      {"pulse", "(t, 0, 2)"},  {"smooth", "(t, 0.1, 1.3)"}};
  for (const std::string& name : floe::math::formula_names()) {
    if (name == "pi" || name == "e") continue;
    const auto found = arguments.find(name);
    texts.push_back("3*" + name + (found == arguments.end() ? "(t)" : found->second) + " + pi*t^2 + e");
  }
  const double t = 0.37, h = 1e-4;
  for (const std::string& text : texts) {
    INFO(text);
    const Formula f(text, of_t, {});
    const double before = f(t - h), here = f(t), after = f(t + h);
    CHECK(f.derivative(t) == Approx((after - before) / (2 * h)).epsilon(1e-6).margin(1e-6));
    CHECK(f.second_derivative(t) == Approx((after - 2 * here + before) / (h * h)).epsilon(1e-5).margin(1e-5));
  }
}

TEST_CASE("a smooth step begins and ends without speed and acceleration") {
  const Formula f("3*smooth(t, 1, 3)", of_t, {});
  CHECK(f(0.5) == 0);
  CHECK(f(1.5) == Approx(3 * (10 - 15 * 0.25 + 6 * 0.0625) / 64));
  CHECK(f(2) == Approx(1.5));
  CHECK(f(4) == 3);
  for (const double t : {1 + 1e-9, 3 - 1e-9}) {
    CHECK(std::abs(f.derivative(t)) < 1e-15);
    CHECK(std::abs(f.second_derivative(t)) < 1e-7);
  }
}

TEST_CASE("functions of the scene: formulas and tables, with the chain rule") {
  using floe::math::function_of;
  using floe::math::Table;
  floe::math::Names names{{"w", 2}};
  names.functions["wave"] = function_of(Formula("sin(w*t)", of_t, names));
  names.functions["twice"] = function_of(Formula("wave(wave(t))", of_t, names));
  names.functions["line"] = function_of(Table{{0, 1, 3}, {0, 2, 0}});
  names.functions["cubic"] = function_of(Table{{0, 1, 2, 3}, {0, 1, 8, 27}, Table::Interpolation::cubic});
  names.functions["hill"] = function_of(Table{{0, 1, 2}, {0, 1, 0}, Table::Interpolation::cubic, true});
  const auto f = [&](const std::string& text) { return Formula(text, of_t, names); };
  CHECK(f("wave(3*t)").second_derivative(0.2) == Approx(-36 * std::sin(1.2)));
  CHECK(f("twice(t)").derivative(0.3) == Approx(4 * std::cos(2 * 0.3) * std::cos(2 * std::sin(0.6))));
  CHECK(f("line(t)")(-1) == 0);
  CHECK(f("line(2*t)")(0.25) == 1);
  CHECK(f("line(2*t)").derivative(0.25) == 4);
  CHECK(f("line(t)")(2) == 1);
  CHECK(f("line(t)").derivative(2) == -1);
  CHECK(f("line(t)")(7) == 0);
  // monotone: between 0 and 27, through the points, slopes as differences have them
  double last = -1;
  for (double t = 0; t <= 3; t += 0.01) {
    CHECK(f("cubic(t)")(t) >= last);
    last = f("cubic(t)")(t);
    if (std::abs(t - std::round(t)) < 1e-3 || t < 0.02) continue;
    const double h = 1e-5, difference = (f("cubic(t)")(t + h) - f("cubic(t)")(t - h)) / (2 * h);
    CHECK(f("cubic(t)").derivative(t) == Approx(difference).epsilon(1e-6).margin(1e-6));
  }
  CHECK(f("cubic(t)")(2) == Approx(8));
  // first and last rise small beside their neighbour: a parabola through three points would turn back there
  names.functions["gentle"] = function_of(Table{{0, 1, 2, 3}, {0, 0.1, 1.9, 2}, Table::Interpolation::cubic});
  for (const double t : {0.1, 0.3, 0.5, 0.7, 0.9}) {
    CHECK((f("gentle(t)")(t) > 0 && f("gentle(t)")(t) < 0.1));
    CHECK((f("gentle(t)")(2 + t) > 1.9 && f("gentle(t)")(2 + t) < 2));
  }
  CHECK(f("hill(t)")(5.5) == Approx(f("hill(t)")(1.5)));
  CHECK(f("hill(t)")(-0.5) == Approx(0.5));
  CHECK(f("hill(t)").derivative(7) == Approx(0).margin(1e-12));
  CHECK_THROWS_WITH(f("line(t, 2)"), Contains("line has 1 arguments, not 2"));
}
