#include <catch2/catch.hpp>
#include <map>

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
  span: {at: beam.end, relative_to: {body: beam, node: [1.5, 0]}, quantity: position}
)yaml";

}  // namespace

TEST_CASE("a split body becomes its parts, clamped end to start, with places and loads on them") {
  const scene::Scene whole = scene::parse_scene(split, "test.yaml"),
                     parts = plan::split_frames(whole, PETSC_COMM_WORLD);
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
  CHECK(parts.probes.back().at.body == "beam#4");
  CHECK(parts.probes.back().relative_to.value().body == "beam#1");
}

TEST_CASE("places of a split body stay where they are") {
  for (const auto formulation : testing::all_formulations()) {
    INFO(scene::name_of(formulation));
    const assembly::Model model = built(split, formulation);
    const auto columns = assembly::probe_columns(model);
    const auto values = at_start(model);
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const std::map<std::string, double> known{{"tip.x", 5}, {"third.x", 3.5}, {"joint.x", 3}, {"span.x", 3.5}};
      const double x = columns[i].name.back() == 'x' ? known.at(columns[i].name) : 0;
      CHECK(values[i] == Approx(x).epsilon(1e-13).margin(1e-14));
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

namespace {

const char* plate = R"yaml(
bodies:
  strip:
    mesh: {plate: {along: [8, 0, 0], across: [0, 1, 0], elements: [8, 2]}}
    section: {thickness: 0.1}
    material: {E: 1e6, nu: 0.3, rho: 1}
    frames: 4
    reduction: {modes: 1, derivatives: none}
joints:
  clamp: {type: fixed, between: [ground, strip.left]}
loads:
  tip: {type: force, at: strip.right, force: [0, 0, 1]}
  gust: {type: pressure, body: strip, pressure: 2}
probes:
  tip: {at: strip.right, quantity: position}
  cut: {at: {body: strip, node: [4, 0.5, 0]}, quantity: position}
  inside: {at: {body: strip, node: [5, 1, 0]}, quantity: position}
)yaml";

/// A fork of beams: its stem along x, then two arms.
const char* branched = R"yaml(
bodies:
  fork:
    mesh:
      segments:
        points: [[0, 0, 0], [4, 0, 0], [6, 1, 0], [6, -1, 0]]
        join: [[1, 2], [2, 3], [2, 4]]
        elements: [4, 2, 2]
    section: {shape: rectangle, width: 0.1, height: 0.1, orientation: [0, 0, 1]}
    material: {E: 1e6, nu: 0.3, rho: 1}
    frames: 6
joints:
  clamp: {type: fixed, between: [ground, fork.start]}
loads:
  tip: {type: force, at: fork.p4, force: [0, 0, 1]}
)yaml";

scene::Scene split_of(const std::string& text) {
  return plan::split_frames(scene::parse_scene(text, "test.yaml"), PETSC_COMM_WORLD);
}

std::string refused(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  REQUIRE(at != std::string::npos);
  text.replace(at, what.size(), by);
  return testing::complaint(text, Formulation::nlffr);
}

}  // namespace

TEST_CASE("a split plate becomes pieces that share the nodes on the cuts") {
  const scene::Scene parts = split_of(plate);
  REQUIRE(parts.bodies.size() == 4);
  REQUIRE(parts.joints.size() == 4);
  for (int i = 0; i < 3; ++i) {
    const scene::Joint& joint = parts.joints[1 + i];
    CHECK(joint.edges == scene::Joint::Edges::nodes);
    CHECK(joint.first.body == "strip#" + std::to_string(i + 1));
    CHECK(joint.second.body == "strip#" + std::to_string(i + 2));
    for (const scene::Place* place : {&joint.first, &joint.second})
      CHECK(parts.bodies[i + (place == &joint.second)].mesh.piece->cuts.at(place->name).size() == 3);
  }
  CHECK(parts.joints[0].second.body == "strip#1");
  REQUIRE(parts.loads.size() == 5);
  CHECK(parts.loads[0].at.body == "strip#4");
  CHECK(parts.probes[1].at.body == "strip#2");  // the first of both
  CHECK(parts.probes[2].at.body == "strip#3");
}

TEST_CASE("pieces of a split plate fit together, at full order node by node and reduced by their interface vectors") {
  for (const auto formulation : testing::all_formulations()) {
    if (formulation == Formulation::cfr) continue;  // it knows no means of several nodes
    INFO(scene::name_of(formulation));
    const assembly::Model model = built(plate, formulation);
    const auto values = at_start(model);
    const std::vector<double> expected{8, 0.5, 0, 4, 0.5, 0, 5, 1, 0};
    for (std::size_t i = 0; i < expected.size(); ++i)
      CHECK(values[i] == Approx(expected[i]).epsilon(1e-13).margin(1e-13));
    CHECK(model.bodies.size() == 4);
    PetscInt elements = 0;
    for (const auto& body : model.bodies) elements += body.elements;
    CHECK(elements == 32);
    if (formulation == Formulation::nlffr)  // mean axes of three pieces, three cuts of three nodes
      CHECK(model.multipliers == 3 * 6 + 3 * 3 * 6);
  }
}

TEST_CASE("a split branched beam has its arms as pieces of their own") {
  const scene::Scene parts = split_of(branched);
  REQUIRE(parts.bodies.size() == 7);  // four of the stem, the fork, two arms
  std::vector<std::string> joints;
  for (const scene::Joint& joint : parts.joints) joints.push_back(joint.name);
  CHECK(joints ==
        std::vector<std::string>{"clamp", "fork#1-2", "fork#2-3", "fork#3-4", "fork#4-5", "fork#5-6", "fork#5-7"});
  CHECK(parts.loads[0].at.body == "fork#7");
  const assembly::Model model = built(branched, Formulation::nlffr);
  CHECK(model.multipliers == 7 * 6 + 7 * 6);  // mean axes and joints
}

TEST_CASE("what a split body cannot have is refused") {
  CHECK_THAT(refused(plate, "strip.right, force", "strip.top, force"),
             Catch::Contains("lies in several of the 4 floating frames of body strip"));
  CHECK_THAT(refused(plate, "frames: 4", "frames: 9"), Catch::Contains("only 9 planes of nodes"));
  CHECK_THAT(refused(plate, "frames: 4", "frames: 4\n    frame: {type: pinned, from: p1, to: p2}"),
             Catch::Contains("mean-axis, or no frame"));
  CHECK_THAT(refused(plate, "modes: 1,", "modes: 1, interface: [left],"), Catch::Contains("several frames"));
  CHECK_THAT(refused(plate, "strip.right, force", "strip.rihgt, force"), Catch::Contains("did you mean \"right\""));
}
