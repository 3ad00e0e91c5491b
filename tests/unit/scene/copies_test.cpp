#include <catch2/catch.hpp>

#include "floe/error.h"
#include "floe/scene/variation.h"

using namespace floe;
using scene::parse_scene;

namespace {

const std::string two_arms = R"yaml(
parameters: {a: 0.5}
bodies:
  left:
    mesh: {line: {from: [0, 0], to: [2, 0], elements: 4}}
    section: {EA: 1e4, EI: 10, rhoA: 2, rhoI: 0}
    reduction: {modes: 3}
    initial: {position: [0, 1]}
  right: {like: left, initial: {angle: a}}
  third: {like: right, section: {EA: 1e4, EI: 20, rhoA: 2, rhoI: 0}}
joints:
  root: {type: spring, between: [ground, left.start], stiffness: 7}
  other: {like: root, between: [ground, right.start]}
loads:
  tip: {type: force, at: left.end, force: [0, "3*t"]}
  down: {like: tip, at: third.end, axes: body}
motion: {end: 1, step: 0.1}
probes:
  p: {at: left.end, quantity: velocity}
  q: {like: p, at: right.end}
)yaml";

std::string fault_of(const std::string& text) {
  try {
    parse_scene(text, "scene");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("copies: keys of the original but for those that the copy has, as a whole") {
  const scene::Scene scene = parse_scene(two_arms, "scene");
  const scene::Body &left = scene.bodies[0], &right = scene.bodies[1], &third = scene.bodies[2];
  CHECK(right.name == "right");
  CHECK(right.mesh.elements == left.mesh.elements);
  CHECK(right.section.EI == 10);
  CHECK(right.reduction.modes.count == 3);
  CHECK(right.initial.angle == 0.5);
  CHECK(right.initial.position[1] == 0);  // `initial` is replaced as a whole
  CHECK(third.section.EI == 20);
  CHECK(third.initial.angle == 0.5);
  CHECK(scene.joints[1].stiffness == 7);
  CHECK(scene.joints[1].second.body == "right");
  CHECK(scene.loads[1].force[1](2.) == 6);
  CHECK(scene.loads[1].axes == scene::Load::Axes::body);
  CHECK(scene.loads[0].axes == scene::Load::Axes::world);
  CHECK(scene.probes[1].quantity == scene::Probe::Quantity::velocity);
  CHECK(scene.probes[1].at.body == "right");
}

TEST_CASE("copies: a value of the original that is varied is that of its copies") {
  const scene::Scene scene = parse_scene(two_arms, "scene", {{"bodies.left.section.EI", 15}, {"a", 0.25}});
  CHECK(scene.bodies[0].section.EI == 15);
  CHECK(scene.bodies[1].section.EI == 15);
  CHECK(scene.bodies[2].section.EI == 20);
  CHECK(scene.bodies[1].initial.angle == 0.25);
  CHECK(scene::offline_inputs(two_arms, "scene", {{"bodies.left.section.EI", 15}}) !=
        scene::offline_inputs(two_arms, "scene", {}));
}

TEST_CASE("copies: a fault in a value that copies have is reported once") {
  std::string text = two_arms;
  text.replace(text.find("rhoA: 2"), 7, "rhoA: x");
  const std::string said = fault_of(text);
  CHECK_THAT(said, Catch::Contains("bodies.left.section.rhoA") && !Catch::Contains("bodies.right"));
}

TEST_CASE("copies: of what is not there, of itself, and in a circle") {
  const auto with = [](const std::string& like, const std::string& other) {
    return "bodies:\n  a: {like: " + like + "}\n  b: {like: " + other + "}\n";
  };
  CHECK_THAT(fault_of(with("[b]", "a")), Catch::Contains("scene:2:13: bodies.a.like: is a list"));
  CHECK_THAT(fault_of(with("bb", "a")),
             Catch::Contains("bodies.a.like: is \"bb\"; expected one of the bodies a, b; did you mean \"b\"?"));
  CHECK_THAT(fault_of(with("b", "a")), Catch::Contains("depends on itself"));
  CHECK_THAT(fault_of(with("a", "a")), Catch::Contains("bodies.a.like: is \"a\", which depends on itself"));
}
