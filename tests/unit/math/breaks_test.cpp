#include "floe/math/breaks.h"

#include <catch2/catch.hpp>
#include <cmath>

using floe::math::Break;
using floe::math::Breaks;
using floe::math::Formula;

// Where formulas have kinks and jumps, by what a reader of the formula sees.

namespace {

Breaks of(const std::string& text, double spacing = 1e-3) {
  return floe::math::breaks(Formula(text, {"t"}, {{"a", 0.1}}), 0, 1, spacing);
}

void check_at(const Breaks& found, const std::vector<double>& times) {
  REQUIRE(found.at.size() == times.size());
  for (std::size_t i = 0; i < times.size(); ++i) {
    CHECK(found.at[i].before <= times[i]);
    CHECK(found.at[i].after >= times[i]);
    CHECK(found.at[i].after - found.at[i].before < 1e-14);
  }
}

}  // namespace

TEST_CASE("a smooth formula has no breaks") {
  for (const char* text : {"2500*sin(9.5*t)", "3", "t^3 - 2*t^2", "exp(-t)/(1 + t^2)"}) {
    INFO(text);
    CHECK(of(text).at.empty());
  }
}

TEST_CASE("a ramp breaks at both of its ends, with its derivatives on either side") {
  const Breaks found = of("5*ramp(t, a, .3)");
  check_at(found, {0.1, 0.3});
  CHECK(found.at[0].left[1] == 0);
  CHECK(found.at[0].right[1] == Approx(25));
  CHECK(found.at[1].left[1] == Approx(25));
  CHECK(found.at[1].right[1] == 0);
  CHECK(found.at[1].left[0] == Approx(5));
  CHECK(found.size[0] == Approx(5));
}

TEST_CASE("breaks of conditions, min, max, abs, rint, pulse and triangle, also nested") {
  check_at(of("t < 0.37 ? 0 : 1"), {0.37});
  check_at(of("t*t < 0.49 && t > 0.2 ? 1 : 0"), {0.2, 0.7});
  check_at(of("min(t, 0.4, 1 - t)"), {0.4, 0.5, 0.6});
  check_at(of("max(sin(t), cos(t))"), {M_PI / 4});
  check_at(of("abs(cos(2*pi*t))"), {0.25, 0.75});
  check_at(of("rint(2*t)"), {0.25, 0.75});
  check_at(of("pulse(t, .2, .8)"), {0.2, 0.8});
  check_at(of("triangle(t - .25, .25, .25)"), {0.25, 0.5, 0.75});
  check_at(of("sin(max(0, abs(t - .5) - .125))"), {0.375, 0.5, 0.625});
  check_at(of("t > .5 ? abs(t - .75) : abs(t - .8)"), {0.5, 0.75});  // the branch that is not taken counts nothing
}

TEST_CASE("breaks much nearer to one another than the samples, where switches are linear in time") {
  check_at(of("pulse(t, .1234567, .1234568)", 0.1), {0.1234567, 0.1234568});
}

TEST_CASE("powers and roots end where their base vanishes, and where it only touches zero") {
  check_at(of("sqrt(t^3)"), {0});
  check_at(of("abs(t - .5)^1.5"), {0.5});
  check_at(of("((t - .5)^2)^.75"), {0.5});
  CHECK(of("sqrt(t^3)").at[0].right[2] > 1e4);
}

TEST_CASE("breaks do not depend on the interval and the samples") {
  const Formula f("ramp(t, .1/3, .3/7) + abs(sin(9*t))", {"t"}, {});
  const Breaks some = floe::math::breaks(f, 0, 0.9, 1e-3), more = floe::math::breaks(f, 0, 1.7, 3e-4);
  REQUIRE(more.at.size() > some.at.size());
  for (std::size_t i = 1; i < some.at.size(); ++i) {
    CHECK(some.at[i].before == more.at[i].before);
    CHECK(some.at[i].after == more.at[i].after);
  }
}

TEST_CASE("tables break at their points") {
  using floe::math::Table;
  floe::math::Names names;
  names.functions["line"] = floe::math::function_of(Table{{0.2, 0.5, 0.8}, {0, 1, 3}});
  names.functions["saw"] =
      floe::math::function_of(Table{{0, 0.1, 0.3, 0.4}, {0, 1, -1, 0}, Table::Interpolation::linear, true});
  names.functions["cubic"] = floe::math::function_of(Table{{0.2, 0.5, 0.8}, {0, 1, 3}, Table::Interpolation::cubic});
  const auto in = [&](const std::string& text) { return floe::math::breaks(Formula(text, {"t"}, names), 0, 1, 1e-3); };
  check_at(in("line(t)"), {0.2, 0.5, 0.8});
  CHECK(in("line(t)").at[1].right[1] == Approx(2 / 0.3));
  check_at(in("cubic(t)"), {0.2, 0.5, 0.8});
  check_at(in("smooth(t, 0.3, 0.6)"), {});
  check_at(in("smooth(t, 0.3, 0.3)"), {0.3});
  check_at(in("saw(t + 0.05)"), {0.05, 0.25, 0.35, 0.45, 0.65, 0.75, 0.85});
}
