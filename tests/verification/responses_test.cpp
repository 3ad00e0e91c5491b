#include <catch2/catch.hpp>

#include "../../src/app/compare_table.h"
#include "scene_motion.h"

using namespace floe;
using namespace floe::test;

namespace {

app::RunResult moved(const std::string& text, Formulation formulation) {
  app::RunPlan plan;
  plan.quiet = true, plan.check_range = false;
  return app::run(scene::parse_scene(text, "scene"), formulation, PETSC_COMM_WORLD, std::nullopt, plan);
}

/// Labels of the basis vectors that are kept.
std::vector<std::string> labels(const app::RunResult& result) {
  std::vector<std::string> all;
  for (const auto& column : result.summary["bodies"][0]["basis"])
    if (column["kept"]) all.push_back(column["column"]);
  return all;
}

const std::string cantilever = R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 12}}
    section: {EA: 1.2e4, EI: 1, rhoA: 1}
    frame: {type: clamped, at: start}
    reduction: {modes: $modes, derivatives: none, attachment: none$more}
joints: {clamp: {type: fixed, between: [ground, beam.start]}}
loads: {tip: {type: force, at: beam.end, force: [0, "$F"]}}
motion: {end: $end, step: $step}
probes: {tip: {at: beam.end, quantity: displacement}}
)yaml";

std::string slow(const char* more) {
  return fill(cantilever,
              {{"modes", "1"}, {"more", more}, {"F", "1e-3*smooth(t, 0, 30)"}, {"end", "30"}, {"step", "0.05"}});
}
std::string fast(const char* more) {
  return fill(cantilever, {{"modes", "2"}, {"more", more}, {"F", "sin(9*t)"}, {"end", "1"}, {"step", "2e-3"}});
}

}  // namespace

// Under a slow load of its tip the residual of one mode is what that mode lacks of the static deflection P L^3/(3 EI),
// of which it has 12/beta_1^4 = 0.9707.
TEST_CASE("residual responses: one of them has the static deflection that is missing in the mode") {
  const double exact = 1e-3 / 3;
  const double mode = moved(slow(""), Formulation::vm_md).series.values.back()[1];
  CHECK(mode == Approx(12 / std::pow(1.875104069, 4) * exact).epsilon(2e-3));
  const app::RunResult with = moved(slow(", responses: 1"), Formulation::vm_md);
  CHECK(with.series.values.back()[1] == Approx(exact).epsilon(2e-4));
  CHECK(labels(with) == std::vector<std::string>{"mode 1", "response 1"});
}

TEST_CASE("residual responses: the full-order motion is approached, without derivatives") {
  const app::Series full = moved(fast(""), Formulation::nlffr).series;
  const double none = app::worst_error(moved(fast(""), Formulation::vm_md).series, full);
  double before = none;
  for (const char* count : {"2", "5", "11"}) {  // in one round, one, and two
    const std::string more = std::string(", responses: ") + count;
    const app::RunResult result = moved(fast(more.c_str()), Formulation::vm_md);
    const double error = app::worst_error(result.series, full);
    INFO(count << " responses: " << error << ", before " << before);
    CHECK(result.coordinates == 5 + std::stoi(count));  // frame, modes
    CHECK(error < 0.5 * before);
    before = error;
  }
  CHECK(none > 0.05);
  CHECK(before < 1e-3);
}

TEST_CASE("residual responses: added to the basis of the scene, in every frame, with its elastic force") {
  const std::string text = fast(", responses: 3, elastic_force: linear");
  CHECK(labels(moved(text, Formulation::vm_md)) ==
        std::vector<std::string>{"mode 1", "mode 2", "response 1", "response 2", "response 3"});
  CHECK(labels(moved(text, Formulation::vm)) == std::vector<std::string>{"mode 1", "mode 2"});
  std::string two = fast(", responses: 3");
  two.replace(two.find("    frame:"), 10, "    frames: 2\n    frame:");
  const History split = history_of(two, Formulation::vm_md);
  REQUIRE(split.model.bodies.size() == 2);
  for (const auto& body : split.model.bodies) CHECK(body.columns == 5);
  const History all = history_of(fast(", responses: 200"), Formulation::vm_md);
  CHECK(all.model.bodies[0].columns < 40);  // 36 dofs
  CHECK(std::any_of(all.model.warnings.begin(), all.model.warnings.end(), [](const std::string& warning) {
    return warning.find("residual responses instead of 200") != std::string::npos;
  }));
}

TEST_CASE("residual responses: without a motion, or with events at joints, they are refused") {
  std::string rest = fast(", responses: 2");
  rest.erase(rest.find("motion:"), rest.find("probes:") - rest.find("motion:"));
  CHECK_THROWS_WITH(scene::parse_scene(rest, "scene"),
                    Catch::Contains("bodies.beam.reduction.responses") && Catch::Contains("no motion"));
  CHECK_THROWS_WITH(scene::parse_scene(fast(", responses: 2") + "events: {go: {at: 0.5, unlock: clamp}}\n", "scene"),
                    Catch::Contains("events that change joints"));
}
