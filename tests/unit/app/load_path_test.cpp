#include "../../../src/app/load_path.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "printed.h"
#include "scene_motion.h"
#include "truss.h"

using namespace floe;
using namespace floe::test;
using Catch::Matchers::Contains;

namespace {

constexpr double rise = 0.05;

app::RunResult equilibria(const std::string& text, Formulation formulation, const app::LoadSteps& load) {
  return app::rest(scene::parse_scene(text, "scene"), formulation, PETSC_COMM_WORLD, load, std::nullopt, false);
}

std::string warnings_of(const app::RunResult& result) {
  std::string all;
  for (const std::string& one : result.warnings) all += one + "\n";
  return all;
}

/// Heights of the truss' apex above its supports.
std::vector<double> heights(const app::RunResult& result) {
  std::vector<double> all;
  for (std::size_t c = 0; c < result.series.columns.size(); ++c)
    if (result.series.columns[c].name == "apex.y")
      for (const auto& row : result.series.values) all.push_back(rise + row[c]);
  return all;
}

/// Straight bars of engineering strain: P = 2 EA (l0 - l)/l0 x/l with l^2 = 1 + x^2; limits where l^3 = l0.
double load_at(double x) {
  const double l = std::hypot(1, x), l0 = std::hypot(1, rise);
  return 2e3 * (l0 - l) / l0 * x / l;
}
double limit_load() { return load_at(std::sqrt(std::pow(std::hypot(1, rise), 2. / 3) - 1)); }

/// A clamped column of length 1, EI = 1, under an axial force t with these settings.
std::string column(const std::string& settings) {
  return fill(R"yaml(
bodies: {beam: {mesh: {line: {from: [0, 0], to: [1, 0], elements: 8}}, section: {EA: 1e6, EI: 1, rhoA: 1}}}
joints: {clamp: {type: fixed, between: [ground, beam.start]}}
loads: {push: {type: force, at: beam.end, force: [-t, 0]$settings}}
probes: {tip: {at: beam.end}}
)yaml",
              {{"settings", settings}});
}

}  // namespace

TEST_CASE("static --path: both limit points of von Mises' truss, in the summary and among the warnings") {
  const double limit = limit_load();
  const app::RunResult path = equilibria(truss(rise), Formulation::cfr, {2 * limit, 10, true, 1000});
  const std::vector<double> x = heights(path);
  REQUIRE(x.size() == path.series.t.size());
  for (std::size_t i = 0; i < x.size(); ++i) CHECK(path.series.t[i] == Approx(load_at(x[i])).margin(1e-4 * limit));
  const auto& found = path.summary["path"];
  REQUIRE(found["limit_points"].size() == 2);
  for (const int i : {0, 1}) {
    const auto& point = found["limit_points"][i];
    CHECK(point["t"].get<double>() == Approx(i == 0 ? limit : -limit).epsilon(1e-5));
    CHECK(load_at(rise + point["probes"]["apex.y"].get<double>()) == Approx(i == 0 ? limit : -limit).epsilon(1e-4));
  }
  CHECK(found["at_end"] == true);
  CHECK(found["bifurcations"].empty());
  // between the limit points one direction is unstable
  REQUIRE(found["unstable_directions"].size() == x.size());
  const double steepest = std::sqrt(std::pow(std::hypot(1, rise), 2. / 3) - 1);
  for (std::size_t i = 0; i < x.size(); ++i)
    if (const auto& count = found["unstable_directions"][i]; !count.is_null())
      CHECK(count == (std::abs(x[i]) < steepest ? 1 : 0));
  CHECK_THAT(warnings_of(path), Contains("limit points at t = ") && Contains("unstable equilibria, the first at t"));
  CHECK_THAT(path.estimate.none, Contains("a path of equilibria is not estimated"));
}

TEST_CASE("static --path: too few points end it with a warning") {
  const double limit = limit_load();
  const app::RunResult path = equilibria(truss(rise), Formulation::cfr, {2 * limit, 10, true, 5});
  CHECK(path.summary["path"]["at_end"] == false);
  CHECK(path.steps == 5);
  CHECK_THAT(warnings_of(path), Contains("after 5 points (--points)") && Contains("not at t = "));
}

TEST_CASE("static --path: Euler's load is a bifurcation between two points") {
  const app::RunResult path = equilibria(column(""), Formulation::cfr, {3, 12, true, 1000});
  const auto& all = path.summary["path"]["bifurcations"];
  REQUIRE(all.size() == 1);
  CHECK(all[0]["from"].get<double>() < M_PI * M_PI / 4);
  CHECK(all[0]["to"].get<double>() > M_PI * M_PI / 4);
  CHECK((all[0]["before"] == 0 && all[0]["after"] == 1));
  CHECK_THAT(warnings_of(path), Contains("the path passes a bifurcation between t = "));
}

TEST_CASE("static --path: beside follower forces stability is not determined") {
  const app::RunResult path = equilibria(column(", axes: place"), Formulation::cfr, {3, 4, true, 1000});
  for (const auto& count : path.summary["path"]["unstable_directions"]) CHECK((count.is_null() || count == 0));
  CHECK(path.summary["path"]["unstable_directions"].back().is_null());
  CHECK_THAT(warnings_of(path), Contains("stability is not determined at"));
  CHECK(path.summary["path"]["bifurcations"].empty());
}

TEST_CASE("static: a truss that snaps through is reported with its jump") {
  const double limit = limit_load();
  const app::RunResult steps = equilibria(truss(rise), Formulation::cfr, {2 * limit, 3});
  const std::vector<double> x = heights(steps);
  REQUIRE(x.size() == 4);
  CHECK(x.front() == Approx(rise));
  CHECK(x[1] > 0);
  CHECK(x.back() < -rise);
  for (std::size_t i = 0; i < x.size(); ++i)
    CHECK(load_at(x[i]) == Approx(limit * 2 / 3 * static_cast<double>(i)).margin(1e-4 * limit));
  REQUIRE(steps.summary["jumps"].size() == 1);
  CHECK(steps.summary["jumps"][0]["from"].get<double>() <= limit * (1 + 1e-9));
  CHECK(steps.summary["jumps"][0]["to"].get<double>() >= limit * (1 - 1e-9));
  CHECK_THAT(warnings_of(steps), Contains("the equilibrium jumps between t = ") && Contains("(apex.y from -0.008"));
}

TEST_CASE("static: where no load has grown yet that would hold the configuration, the table begins at the first step") {
  // a hanging chain of one rod without gravity at t = 0
  const app::RunResult hung = equilibria(R"yaml(
bodies: {rod: {rigid: true, mesh: {line: {from: [0, 0], to: [1, 0], elements: 1}}, section: {rhoA: 2}}}
joints: {pin: {type: revolute, between: [ground, rod.start]}}
loads: {pull: {type: force, at: rod.end, force: ["3*t", "4*t"]}}
probes: {tip: {at: rod.end, quantity: position}}
)yaml",
                                         Formulation::nlffr, {1, 2});
  REQUIRE(hung.series.t.size() == 2);
  CHECK(hung.series.t.front() == Approx(0.5));
  for (const auto& row : hung.series.values) {  // along the force
    CHECK(row[0] == Approx(0.6).epsilon(1e-6));
    CHECK(row[1] == Approx(0.8).epsilon(1e-6));
  }
  CHECK_THAT(warnings_of(hung), Contains("the table begins at t = 0.5"));
}
