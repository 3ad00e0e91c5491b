#include <yaml-cpp/yaml.h>

#include <catch2/catch.hpp>

#include "../../../src/assess/candidate_basis_text.h"

using namespace floe;

TEST_CASE("a scene written into another folder names its files from there, once for all aliases") {
  scene::Scene scene;
  scene.file = "/models/wing/scene.yaml";
  scene.text = R"yaml(
functions:
  gust: {file: loads/gust.csv, column: 2}
  calm: {file: /data/calm.csv}
  wave: "sin(t)"
bodies:
  left: {mesh: &plate {file: {path: plate.inp}}}
  right: {mesh: *plate}
  tail: {mesh: {file: {path: ../tail.msh, parts: [skin]}}}
  hub: {reduced: hub.h5}
  rod: {mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: 2}}}
motion: {end: 1, step: 0.1}
)yaml";
  scene.motion.end = 1, scene.motion.step = 0.1;
  const YAML::Node moved =
      YAML::Load(assess::candidates_text(scene, {}, {}, scene.motion, {}, true, {}, "/models/results/today"));
  const auto text = [](const YAML::Node& node) { return node.as<std::string>(); };
  CHECK(text(moved["functions"]["gust"]["file"]) == "../../wing/loads/gust.csv");
  CHECK(text(moved["functions"]["calm"]["file"]) == "/data/calm.csv");
  CHECK(text(moved["functions"]["wave"]) == "sin(t)");
  CHECK(text(moved["bodies"]["left"]["mesh"]["file"]["path"]) == "../../wing/plate.inp");
  CHECK(text(moved["bodies"]["right"]["mesh"]["file"]["path"]) == "../../wing/plate.inp");
  CHECK(text(moved["bodies"]["tail"]["mesh"]["file"]["path"]) == "../../tail.msh");
  CHECK(text(moved["bodies"]["hub"]["reduced"]) == "../../wing/hub.h5");
}
