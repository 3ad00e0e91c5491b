#include "../../../src/app/compare_table.h"

#include <catch2/catch.hpp>
#include <sstream>

using namespace floe;
using namespace floe::app;

namespace {

/// Probes tip (3, 4) and end (0, 2) at three times, `off` added to every component.
Compared run(const std::string& name, double off) {
  Compared run{name, {}};
  run.result.label = name;
  run.result.series.columns = {{"tip.x", "m"}, {"tip.y", "m"}, {"end.x", "m"}, {"end.y", "m"}};
  for (int i = 0; i < 3; ++i) {
    run.result.series.t.push_back(i);
    run.result.series.values.push_back({3 + off, 4 + off, off, 2 + off});
  }
  return run;
}

std::size_t widest(const std::string& text) {
  std::istringstream lines(text);
  std::size_t most = 0;
  for (std::string line; std::getline(lines, line);) most = std::max(most, line.size());
  return most;
}

}  // namespace

TEST_CASE("errors of components and of vectors") {
  const Series reference = run("cfr", 0).result.series, series = run("vm", 0.5).result.series;
  const auto components = relative_errors(series, reference);
  REQUIRE(components.size() == 4);
  CHECK(*components[0] == Approx(0.5 / 3));
  CHECK(*components[1] == Approx(0.5 / 4));
  CHECK_FALSE(components[2]);  // the reference is zero there
  CHECK(*components[3] == Approx(0.25));
  const auto vectors = vector_errors(series, reference);
  REQUIRE(vectors.size() == 2);
  CHECK(vectors[0] == Approx(std::sqrt(0.5) / 5));  // |(0.5, 0.5)| / |(3, 4)|
  CHECK(vectors[1] == Approx(std::sqrt(0.5) / 2));
}

TEST_CASE("a comparison shows components where they fit, else vectors") {
  const std::vector<Compared> rows = {run("cfr", 0), run("vm", 0.5)};
  const std::vector<const Compared*> references = {&rows[0]};
  const std::string wide = comparison_text(rows, references, {}, nullptr, 120);
  CHECK(wide.find("[% cfr]") != std::string::npos);
  CHECK(wide.find("tip.x") != std::string::npos);
  CHECK(widest(wide) <= 120);
  const std::string narrow = comparison_text(rows, references, {}, nullptr, static_cast<int>(widest(wide)) - 1);
  CHECK(narrow.find("tip.x") == std::string::npos);
  CHECK(narrow.find("    tip ") != std::string::npos);
  CHECK(narrow.find("compare.csv") != std::string::npos);
  CHECK(comparison_text(rows, references, {}, nullptr, static_cast<int>(widest(wide))) == wide);
  const output::Table table = comparison(rows, references, {}, nullptr, true);
  REQUIRE(table.columns.size() == 3 + 4 + 3);
  CHECK(table.columns[3].name == "tip.x vs cfr");
}

TEST_CASE("a comparison has the time of a step in microseconds") {
  std::vector<Compared> rows = {run("cfr", 0)};
  rows[0].result.motion_seconds = 3, rows[0].result.steps = 1000;
  const output::Table table = comparison(rows, {&rows[0]}, {}, nullptr, true);
  CHECK(table.columns.back().name == "per step");
  CHECK(std::get<double>(table.rows[0].back()) == Approx(3000));
}

TEST_CASE("a comparison leaves out the second reference where both do not fit") {
  const std::vector<Compared> rows = {run("cfr", 0), run("nlffr", 0.1), run("vm", 0.5)};
  const std::vector<const Compared*> references = {&rows[0], &rows[1]};
  CHECK(comparison_text(rows, references, {}, nullptr, 200).find("[% nlffr]") != std::string::npos);
  const std::string narrow = comparison_text(rows, references, {}, nullptr, 80);
  CHECK(narrow.find("[% cfr]") != std::string::npos);
  CHECK(narrow.find("[% nlffr]") == std::string::npos);
  CHECK(widest(narrow) <= 80);
}

TEST_CASE("a comparison marks the formulations that failed") {
  const std::vector<Compared> rows = {run("cfr", 0), run("vm", 0.5)};
  const output::Table table = comparison(rows, {&rows[0]}, {"lffr"}, &rows[0], true);
  REQUIRE(table.rows.size() == 4);
  CHECK(std::get<std::string>(table.rows[2][0]) == "lffr");
  CHECK(std::get<std::string>(table.rows[2][1]) == "failed");
  CHECK(table.rows[2].size() == table.columns.size());
  CHECK(comparison_text(rows, {&rows[0]}, {"lffr"}, nullptr, 200).find("failed") != std::string::npos);
}
