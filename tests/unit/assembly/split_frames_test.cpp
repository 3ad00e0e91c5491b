#include <catch2/catch.hpp>

#include "building.h"

using namespace floe;
using scene::Formulation;
using testing::at_start;
using testing::built;

namespace {

const char* split = R"yaml(
bodies:
  beam:
    mesh: {line: {from: [1, 0], to: [5, 0], elements: 8}}
    section: {EA: 1e4, EI: 10, rhoA: 3}
    frames: 4
    reduction: {modes: 2, derivatives: all}
joints:
  clamp: {type: fixed, between: [ground, beam.start]}
loads:
  tip: {type: force, at: beam.end, force: [0, 1]}
  wind: {type: distributed, body: beam, force: [2, 0]}
motion: {end: 1, step: 0.1}
probes:
  tip: {at: beam.end, quantity: position}
  third: {at: {body: beam, node: [3.5, 0]}, quantity: position}
  joint: {at: {body: beam, node: [3, 0]}, quantity: position}
)yaml";

}  // namespace

TEST_CASE("a split body becomes its parts, clamped end to start, with places and loads on them") {
  const scene::Scene whole = scene::parse_scene(split, "test.yaml"), parts = plan::split_frames(whole);
  REQUIRE(parts.bodies.size() == 4);
  for (int i = 0; i < 4; ++i) {
    CHECK(parts.bodies[i].name == "beam#" + std::to_string(i + 1));
    CHECK(parts.bodies[i].mesh.points[0][0] == Approx(1 + i));
    CHECK(parts.bodies[i].mesh.points[1][0] == Approx(2 + i));
    CHECK(parts.bodies[i].mesh.elements == std::vector<int>{2});
    CHECK(parts.bodies[i].frames == 1);
  }
  REQUIRE(parts.joints.size() == 4);  // the clamp and three between parts
  CHECK(parts.joints[0].second.body == "beam#1");
  CHECK(parts.joints[1].first.body == "beam#1");
  CHECK(parts.joints[1].second.body == "beam#2");
  CHECK(parts.joints[3].kind == scene::Joint::Kind::fixed);
  std::vector<std::string> distributed;
  for (const auto& load : parts.loads) {
    if (load.kind == scene::Load::Kind::distributed) distributed.push_back(load.body);
    if (load.kind == scene::Load::Kind::force) CHECK(load.at.body == "beam#4");
  }
  CHECK(distributed == std::vector<std::string>{"beam#1", "beam#2", "beam#3", "beam#4"});
}

TEST_CASE("places of a split body stay where they are") {
  for (const auto formulation : testing::all_formulations()) {
    INFO(scene::name_of(formulation));
    const assembly::Model model = built(split, formulation);
    const auto columns = assembly::probe_columns(model);
    const auto values = at_start(model);
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const double x = columns[i].name == "tip.x" ? 5 : columns[i].name == "third.x" ? 3.5 : 3;
      CHECK(values[i] == Approx(columns[i].name.back() == 'x' ? x : 0).epsilon(1e-13).margin(1e-14));
    }
    CHECK(model.multipliers == (formulation == Formulation::cfr ? 3 : 12));
  }
}

TEST_CASE("frames that do not divide the elements, or a mesh of several segments, are refused") {
  std::string text = split;
  text.replace(text.find("frames: 4"), 9, "frames: 3");
  CHECK_THAT(testing::complaint(text, Formulation::nlffr), Catch::Contains("frames: is 3 for 8 elements"));
  text = split;
  text.replace(text.find("line: {from: [1, 0], to: [5, 0], elements: 8}"), 45,
               "polyline: {points: [[1, 0], [3, 0], [5, 0]], elements: 4}");
  CHECK_THAT(testing::complaint(text, Formulation::nlffr), Catch::Contains("several segments"));
}
