#include <catch2/catch.hpp>

#include "space_twin.h"

using namespace floe;
using namespace floe::test;

namespace {

/// An arm of two flexible links on the ground, with a motor in its elbow that follows a reference, a force that depends
/// on the motion in world axes, a force that rotates with its place, and a spring to the ground; and `more` of each
/// section.
std::string arms(std::map<std::string, std::string> more) {
  for (const char* section : {"bodies", "joints", "loads", "probes", "copies"}) more.emplace(section, "");
  return fill(R"yaml(
functions: {ref: "0.3*smooth(t, 0, 0.2)"}
bodies:
  upper:
    mesh: {line: {from: [0, 0, 0], to: [0.5, 0, 0.1], elements: 4}}
    section: &section {shape: rectangle, width: 0.01, height: 0.02, orientation: [0, 0, 1]}
    material: &aluminium {E: 7e10, nu: 0.3, rho: 2700}
    initial: {position: [0.3, 0, 0]}
    reduction: {modes: 2}
  fore:
    mesh: {line: {from: [0, 0, 0], to: [0.4, 0, 0], elements: 4}}
    section: *section
    material: *aluminium
    initial: {position: [0.8, 0, 0.1], rotation: [0, 0, 0.3]}
    reduction: {modes: 2}
$bodies
joints:
  shoulder: {type: revolute, between: [{body: ground, node: [0.3, 0, 0]}, upper.start], axis: [0, 1, 0]}
  elbow: {type: revolute, between: [upper.end, fore.start], axis: [0.1, 1, 0]}
  rope: {type: spring, between: [{body: ground, node: [0.6, 0.2, 0.5]}, fore.end], stiffness: 50, viscosity: 2}
$joints
loads:
  motor: {type: moment, joint: elbow, moment: "-20*(elbow.angle - ref(t)) - 0.4*elbow.rate"}
  push: {type: force, at: fore.end, force: [0, "50*t", "-3*v.z - 2*v.x + 0.5*(p.x - 1)"]}
  own: {type: force, at: upper.end, axes: place, force: [0, 0, "4*sin(9*t)"]}
$loads
motion: {end: 0.1, step: 1e-3}
probes:
  v: {at: fore.end, quantity: velocity}
  p: {at: fore.end, quantity: position}
  f: {joint: shoulder, quantity: force}
$probes
$copies
)yaml",
              Words(more.begin(), more.end()));
}

std::vector<std::string> shared(const assembly::Model& model) {
  std::vector<std::string> all;
  for (const assembly::BodyReport& body : model.bodies) all.push_back(body.reduction_of);
  return all;
}

}  // namespace

// By hand: (x, y, z) -> (-y, x, z + 0.2).
TEST_CASE("copies of groups: the motion of the scene that is written out") {
  const std::string written = arms({{"bodies", R"yaml(
  two_upper: {like: upper, initial: {position: [0, 0.3, 0.2], rotation: [0, 0, pi/2]}}
  two_fore: {like: fore, initial: {position: [0, 0.8, 0.3], rotation: [0, 0, 0.3 + pi/2]}}
)yaml"},
                                    {"joints", R"yaml(
  two_shoulder: {type: revolute, between: [{body: ground, node: [0, 0.3, 0.2]}, two_upper.start], axis: [-1, 0, 0]}
  two_elbow: {type: revolute, between: [two_upper.end, two_fore.start], axis: [-1, 0.1, 0]}
  two_rope: {like: rope, between: [{body: ground, node: [-0.2, 0.6, 0.7]}, two_fore.end]}
)yaml"},
                                    {"loads", R"yaml(
  two_motor: {type: moment, joint: two_elbow, moment: "-20*(two_elbow.angle - ref(t)) - 0.4*two_elbow.rate"}
  two_push: {type: force, at: two_fore.end, force: ["-50*t", 0, "-3*two_v.z - 2*two_v.y + 0.5*(two_p.y - 1)"]}
  two_own: {like: own, at: two_upper.end}
)yaml"},
                                    {"probes", R"yaml(
  two_v: {like: v, at: two_fore.end}
  two_p: {like: p, at: two_fore.end}
  two_f: {like: f, joint: two_shoulder}
)yaml"}});
  const std::string copied =
      arms({{"copies", "copies: {two: {like: [upper, fore], rotation: [0, 0, pi/2], position: [0, 0, 0.2]}}"}});
  const History a = move(copied, Formulation::vm_md), b = move(written, Formulation::vm_md);
  for (const std::string probe : {"v", "p", "two_v", "two_p"}) CHECK(apart(a, b, probe) < 1e-10);
  // round-off of positions over the square of the step
  for (const std::string probe : {"f", "two_f"}) CHECK(apart(a, b, probe) < 1e-8);
}

TEST_CASE("copies of groups: bodies are reduced once, and the copy moves as the original, moved as a whole") {
  const Eigen::Vector3d axis = Eigen::Vector3d(0.4, -0.9, 0.7), shift(0.1, 0.5, 0.2);
  const History at = move(
      arms({{"copies", "copies: {two: {like: [upper, fore], rotation: [0.4, -0.9, 0.7], position: [0.1, 0.5, 0.2]}}"}}),
      Formulation::vm_md);
  CHECK(shared(at.model) == std::vector<std::string>{"", "", "upper", "fore"});
  const Eigen::Matrix3d R = math::rotation(axis);
  double moved = 0;
  for (std::size_t i = 0; i < at.t.size(); ++i) {
    const Eigen::Vector3d p = vector_at(at, "p", i), v = vector_at(at, "v", i), f = vector_at(at, "f", i);
    CHECK((vector_at(at, "two_p", i) - R * p - shift).norm() < 1e-8);
    CHECK((vector_at(at, "two_v", i) - R * v).norm() < 1e-6);
    CHECK((vector_at(at, "two_f", i) - R * f).norm() < 1e-5 * (1 + f.norm()));
    moved = std::max(moved, (p - vector_at(at, "p", 0)).norm());
  }
  CHECK(moved > 0.005);
}

// The joint reacts to moments across its axis, but for round-off, which in some orientations became attachment modes.
TEST_CASE("copies in any orientation have as many attachment modes") {
  std::string copies;
  const double rotations[][3] = {{0.4, -0.7, 1.1},  {-1.6, 0.9, 0.3}, {2.1, 0.2, -1.3}, {0.1, 1.7, 0.6},
                                 {-0.3, -0.4, 2.2}, {1.2, 1.3, -0.2}, {-2.4, 0.5, 0.8}, {0.7, -1.9, -0.5}};
  for (int i = 0; i < 8; ++i)
    copies +=
        fill("  c$i: {like: [a], position: [0, 0, 0], rotation: [$x, $y, $z]}\n", {{"i", std::to_string(i)},
                                                                                   {"x", number(rotations[i][0])},
                                                                                   {"y", number(rotations[i][1])},
                                                                                   {"z", number(rotations[i][2])}});
  const auto model = assembly::build(scene::parse_scene(R"yaml(
bodies:
  a:
    mesh: {polyline: {points: [[0, 0, 0], [0.5, 0, 0.1], [0.9, 0.2, 0]], elements: 4}}
    section: {shape: box, width: 0.02, height: 0.01, wall: 0.001, orientation: [0, 1, 0.3]}
    material: {E: 7e10, nu: 0.3, rho: 2700}
    reduction: {modes: 3, derivatives: 1}
    initial: {position: [0.2, 0.1, 0.3], rotation: [0.1, 0.2, 0.3]}
joints: {r: {type: revolute, between: [ground, a.start], axis: [1, 2, 3]}}
loads: {j: {type: moment, joint: r, moment: "-0.5*r.angle"}}
copies:
)yaml" + copies,
                                                        "scene"),
                                     Formulation::vm_md, PETSC_COMM_WORLD);
  REQUIRE(model.bodies.size() == 9);
  for (const auto& body : model.bodies) {
    int kept = 0;
    for (const auto& origin : body.origins)
      kept += origin.kept && origin.kind == reduction::ColumnOrigin::Kind::attachment;
    INFO(body.name);
    CHECK(kept == 1);
  }
}
