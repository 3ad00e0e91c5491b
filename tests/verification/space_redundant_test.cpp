#include <catch2/catch.hpp>

#include "space_twin.h"

using namespace floe;
using namespace floe::test;
using Catch::Contains;

// A four-bar in a plane: ground (0, 0) and (2, 0), crank 0.5, coupler 1.7, rocker 1.2. In space four hinges with
// parallel axes hold 20 of 18 freedoms and leave one free: three of their rows follow from the others.

namespace {

const Rotated rotation;
const double knee_x = 0.0, knee_y = 0.5;  // the crank stands upright

/// The coupler's far end: |p - knee| = 1.7, |p - (2, 0)| = 1.2, the upper of two.
Eigen::Vector2d far_end() {
  const Eigen::Vector2d a(knee_x, knee_y), b(2, 0), d = b - a;
  const double along = (1.7 * 1.7 - 1.2 * 1.2 + d.squaredNorm()) / (2 * d.norm()),
               off = std::sqrt(1.7 * 1.7 - along * along);
  return a + along * d.normalized() + off * Eigen::Vector2d(-d.y(), d.x()).normalized();
}

std::string body(const std::string& name, const std::string& from, const std::string& to, bool space) {
  return fill(space ? R"yaml(
  $name:
    rigid: true
    mesh: {line: {from: $from, to: $to, elements: 2}}
    section: {shape: rectangle, width: 0.05, height: 0.05, orientation: [0.3, 0.2, 1]}
    material: {E: 1, nu: 0.3, rho: 400}
    frame: pinned
)yaml"
                    : R"yaml(
  $name:
    rigid: true
    mesh: {line: {from: $from, to: $to, elements: 2}}
    section: {A: 0.05^2, I: 0.05^4/12}
    material: {E: 1, rho: 400}
)yaml",
              {{"name", name}, {"from", from}, {"to", to}});
}

std::string in_plane(double x, double y) { return fmt::format("[{:.17g}, {:.17g}]", x, y); }

/// @param place  of a point of the plane
template <class Place>
std::string bars(Place&& place, bool space) {
  const Eigen::Vector2d p = far_end();
  return "bodies:" + body("crank", place(0, 0), place(knee_x, knee_y), space) +
         body("coupler", place(knee_x, knee_y), place(p.x(), p.y()), space) +
         body("rocker", place(p.x(), p.y()), place(2, 0), space) +
         "motion: {end: 1.5, step: 2e-3}\nprobes: {middle: {at: coupler.middle, quantity: position}}\n";
}

/// Axes of the four hinges.
std::string scene_of(const std::array<std::string, 4>& axes) {
  return bars([](double x, double y) { return rotation(x, y); }, true) +
         fill(R"yaml(
gravity: $g
joints:
  a: {type: revolute, between: [ground, crank.start], axis: $0}
  b: {type: revolute, between: [crank.end, coupler.start], axis: $1}
  c: {type: revolute, between: [coupler.end, rocker.start], axis: $2}
  d: {type: revolute, between: [rocker.end, ground], axis: $3}
)yaml",
              {{"g", rotation(0, -9.81)}, {"0", axes[0]}, {"1", axes[1]}, {"2", axes[2]}, {"3", axes[3]}});
}

History plane() {
  return move(bars(in_plane, false) + R"yaml(
gravity: [0, -9.81]
joints:
  a: {type: revolute, between: [ground, crank.start]}
  b: {type: revolute, between: [crank.end, coupler.start]}
  c: {type: revolute, between: [coupler.end, rocker.start]}
  d: {type: revolute, between: [rocker.end, ground]}
)yaml",
              Formulation::vm_md);
}

}  // namespace

TEST_CASE("redundant in space: a four-bar of four hinges moves as in the plane, without three rows of a joint") {
  const std::string z = rotation(0, 0, 1);
  const History flat = plane(), at = move(scene_of({z, z, z, z}), Formulation::vm_md);
  CHECK(apart(at, rotation.Q, flat, "middle") < 1e-9);
  REQUIRE(at.model.warnings.size() == 1);
  CHECK(at.model.warnings[0] == "joint d: 3 of its 5 constraints are redundant with other joints and eliminated");
}

// Screws of the loop: three about parallel axes have rank 3, a fourth that is tilted against them is independent of
// them. Rank 4 of 4 leaves no motion, and 20 rows for 18 freedoms leave 2 over: the mechanism stands, whatever its
// weight.
TEST_CASE("redundant in space: with one axis tilted the four-bar cannot move") {
  const std::string z = rotation(0, 0, 1), tilted = rotation(std::sin(0.05), 0, std::cos(0.05));
  const std::string text = scene_of({z, z, tilted, z});
  const History at = move(text, Formulation::vm_md);
  double moved = 0;
  for (std::size_t i = 0; i < at.t.size(); ++i)
    moved = std::max(moved, (vector_at(at, "middle", i) - vector_at(at, "middle", 0)).norm());
  CHECK(moved < 1e-9);
  REQUIRE(at.model.warnings.size() == 1);
  CHECK(at.model.warnings[0] == "joint d: 2 of its 5 constraints are redundant with other joints and eliminated");
}

// Two arms, welded to one another, each driven by the ground.
TEST_CASE("redundant in space: conflicting drives of one body are refused, equal ones are not") {
  const auto two = [](const std::string& second) {
    return fill(R"yaml(
bodies:
  $arm
  $other
joints:
  one: {type: driven, between: [ground, arm.start], axis: [0, 0, 1], angle: 2*t}
  two: {type: driven, between: [ground, other.start], axis: [0, 0, 1], angle: $second}
  weld: {type: fixed, between: [arm.end, other.end]}
motion: {end: 1, step: 1e-2}
probes: {tip: {at: arm.end, quantity: position}}
)yaml",
                {{"arm", "arm: {$bar}"},
                 {"other", "other: {$bar}"},
                 {"bar",
                  "rigid: true, mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: 2}}, section: {shape: "
                  "circle, radius: 0.05, orientation: [0, 1, 0]}, material: {E: 1, nu: 0.3, rho: 100}"},
                 {"second", second}});
  };
  CHECK_THAT(fault_of_motion(two("3*t")),
             Contains("joint weld is redundant with other joints and inconsistent with them"));
  const History at = move(two("t*2"), Formulation::vm_md);
  CHECK(at.at("tip.x", 1) == Approx(std::cos(2)).epsilon(1e-9));
  REQUIRE(at.model.warnings.size() == 1);
  CHECK(at.model.warnings[0] == "joint weld: 6 of its 6 constraints are redundant with other joints and eliminated");
}
