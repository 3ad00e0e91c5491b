// Motions that start from a static equilibrium.
#include <catch2/catch.hpp>

#include "building.h"
#include "scene_motion.h"

using namespace floe;
using namespace floe::test;
using Catch::Matchers::Contains;

namespace {

/// Weight bends a cantilever by a tenth of its length; a small force shakes it.
const char* sagging = R"yaml(
parameters: {F: $F}
gravity: [0, -9.81]
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 12}}
    section: {EA: 1e5, EI: 10, rhoA: 1}
    reduction: {modes: 3}
joints:
  clamp: {type: fixed, between: [ground, beam.start]}
loads:
  tip: {type: force, at: beam.end, force: [0, "F*sin(20*t)"]}
motion: {end: 0.5, step: 1e-3, start: $start}
probes:
  tip: {at: beam.end}
  f: {joint: clamp}
)yaml";

}  // namespace

TEST_CASE("a motion from equilibrium stays there, in every formulation", "[verification]") {
  for (const auto formulation : testing::all_formulations()) {
    INFO(scene::name_of(formulation));
    const History still = move(fill(sagging, {{"F", "0"}, {"start", "equilibrium"}}), formulation);
    const History at = rest(fill(sagging, {{"F", "0"}, {"start", "given"}}), formulation);
    const double intra_deflection = at["tip.y"].back();
    CHECK(intra_deflection < -0.05);
    for (const double y : still["tip.y"]) CHECK(std::abs(y - intra_deflection) < 1e-7 * std::abs(intra_deflection));
    for (const double f : still["f.y"]) CHECK(std::abs(f - 9.81) < 1e-6);
  }
}

TEST_CASE("adaptive steps about an equilibrium do not shrink to resolve round-off") {
  std::string text = fill(sagging, {{"F", "0"}, {"start", "equilibrium"}});
  text.replace(text.find("step: 1e-3"), 10, "step: 1e-3, tolerance: 1e-3");
  for (const auto formulation : {Formulation::vm_md, Formulation::nlffr})
    CHECK(move(text, formulation).report.steps < 100);
}

TEST_CASE("small vibrations about the shape under gravity do not depend on how it was reached", "[verification]") {
  // the same force about the equilibrium: cfr and vm+md differ by what their models do, not by a start out of balance
  const std::string text = fill(sagging, {{"F", "0.01"}, {"start", "equilibrium"}});
  const History exact = move(text, Formulation::cfr), reduced = move(text, Formulation::vm_md);
  const double base = exact["tip.y"].front(), other = reduced["tip.y"].front();
  double largest = 0, difference = 0;
  for (std::size_t i = 0; i < exact.t.size(); ++i) {
    largest = std::max(largest, std::abs(exact["tip.y"][i] - base));
    difference = std::max(difference, std::abs(exact["tip.y"][i] - base - reduced["tip.y"][i] + other));
  }
  CHECK(largest > 1e-5);
  CHECK(difference < 0.05 * largest);
}

TEST_CASE("a spatial mechanism starts from rest under its weight: a hanging rod on a bushing") {
  const std::string text = R"yaml(
gravity: [0, 0, -10]
bodies:
  rod:
    rigid: true
    mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: 2}}
    section: {shape: rectangle, width: 0.1, height: 0.1, orientation: [0, 1, 0]}
    material: {E: 7e10, nu: 0.3, rho: 100}
joints:
  b: {type: bushing, between: [ground, rod.start], translation: [1e3, 1e3, 1e3], rotation: [100, 100, 100]}
motion: {end: 0.2, step: 1e-3, start: equilibrium}
probes:
  end: {at: rod.end}
)yaml";
  const History still = move(text, Formulation::vm_md);
  CHECK(still["end.z"].front() < -0.05);
  for (const double z : still["end.z"]) CHECK(std::abs(z - still["end.z"].front()) < 1e-8);
}

TEST_CASE("a start from equilibrium is refused where there is none or bodies move") {
  std::string moving = fill(sagging, {{"F", "0"}, {"start", "equilibrium"}});
  moving.replace(moving.find("    reduction:"), 0, "    initial: {velocity: [0, 1]}\n");
  CHECK_THROWS_WITH(scene::parse_scene(moving, "scene"),
                    Contains("motion.start: is equilibrium, and body beam has an initial velocity"));
  std::string free = fill(sagging, {{"F", "0"}, {"start", "equilibrium"}});
  free.replace(free.find("joints:"), free.find("loads:") - free.find("joints:"), "");
  free.replace(free.find("  f: {joint"), std::string::npos, "");
  CHECK_THROWS_WITH(testing::built(free, Formulation::vm_md),
                    Contains("motion.start: no static equilibrium was found at t = 0"));
}
