#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "scene_motion.h"

using namespace floe;
using namespace floe::test;

// A body that joints drive, or hold more than rigidly, deforms in what its fixed-interface modes cannot follow: the
// basis needs the static shape of every constrained dof that the motion moves (Craig and Bampton, AIAA J. 6, 1968).
// Both scenes are measured against the full model of the same mesh.
namespace {

std::string guided(const std::string& start, const std::string& rest) {
  return fill(R"yaml(
bodies:
  b:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 10}}
    section: {EA: 1e4, EI: 1, rhoA: 1}
    reduction: {modes: 5}
joints:
  m: {between: [ground, b.start], $start}
  g: {type: prismatic, between: [ground, b.end], axis: [0, 1]}
motion: {end: 1, step: 2e-3}
probes: {e: {at: b.end}, m: {at: b.middle}}
$rest
)yaml",
              {{"start", start}, {"rest", rest}});
}

void check_agreement(const std::string& text, double tolerance) {
  const History full = move(text, Formulation::nlffr), reduced = move(text, Formulation::vm_md);
  CHECK(relative_error(reduced, full, "e.y") < tolerance);
  CHECK(relative_error(reduced, full, "m.y") < tolerance);
}

}  // namespace

TEST_CASE("constraint modes: driven at one end, guided at the other") {
  check_agreement(guided("type: driven, angle: 0.2*(1-cos(2*t))", ""), 1e-5);
}

TEST_CASE("constraint modes: hinged at one end, guided at the other, under its weight") {
  check_agreement(guided("type: revolute", "gravity: [0, -1]"), 2e-4);
}

// The end clamped, the start rotated by the drive: all six dofs of the ends are prescribed, the shape between is the
// body's.
TEST_CASE("constraint modes: driven at one end, clamped at the other") {
  const std::string reduction = GENERATE("{modes: 5}", "{modes: {count: 5, of: frame}}");
  INFO(reduction);
  check_agreement(fill(R"yaml(
bodies:
  b:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 10}}
    section: {EA: 1e4, EI: 1, rhoA: 1}
    reduction: $reduction
joints:
  m: {type: driven, between: [ground, b.start], angle: 0.05*(1-cos(2*t))}
  g: {type: fixed, between: [ground, b.end]}
motion: {end: 1, step: 2e-3}
probes: {e: {at: {body: b, node: [0.8, 0]}}, m: {at: b.middle}}
)yaml",
                       {{"reduction", reduction}}),
                  1e-3);
}

namespace {

/// A beam or plate in space with its frame clamped at one end and more at the other.
std::string clamped_frame(const std::string& body, const std::string& more, const std::string& load) {
  return fill(R"yaml(
bodies:
  b:
    $body
    material: {E: 7e10, nu: 0.3, rho: 2700}
    frame: {type: clamped, at: $start}
    reduction: {modes: {count: 8, of: frame}, attachment: none}
joints:
  root: {type: fixed, between: [ground, b.$start]}
  other: {$more}
loads: {f: {$load}}
motion: {end: 0.2, step: 1e-3}
probes: {m: {at: {body: b, node: [1, 0, 0]}}, e: {at: b.$end}}
)yaml",
              {{"body", body},
               {"more", more},
               {"load", load},
               {"start", body.find("plate") == std::string::npos ? "start" : "left"},
               {"end", body.find("plate") == std::string::npos ? "end" : "right"}});
}

constexpr const char* clamped_beam =
    "mesh: {line: {from: [0, 0, 0], to: [2, 0, 0], elements: 40}}\n"
    "    section: {A: 4e-4, Iy: 1.3e-8, Iz: 1.3e-8, J: 2e-8, orientation: [0, 1, 0]}";
constexpr const char* clamped_plate =
    "mesh: {plate: {along: [2, 0, 0], across: [0, 1, 0], elements: [8, 4], cells: quadrilaterals}}\n"
    "    section: {thickness: 0.01}";

}  // namespace

// Its modes, those of a cantilever, do not satisfy the hinge at its end. A load on a beam clamped and hinged, in the
// middle: F L^3 7 / (768 E I) at rest, twice that at most after a sudden start.
TEST_CASE("constraint modes: modes of a fixed frame, and another joint to the ground") {
  const std::string scene = clamped_frame(clamped_beam, "type: spherical, between: [ground, b.end]",
                                          "type: force, at: {body: b, node: [1, 0, 0]}, force: [0, 0, 0.5]");
  const double rest = 7 * 0.5 * 8 / (768 * 7e10 * 1.3e-8);
  History full = move(scene, Formulation::nlffr), reduced = move(scene, Formulation::vm_md);
  CHECK(relative_error(reduced, full, "m.z") < 4e-2);
  CHECK(*std::max_element(reduced["m.z"].begin(), reduced["m.z"].end()) == Approx(2 * rest).epsilon(0.1));
  for (const double z : reduced["e.z"]) REQUIRE(std::abs(z) < 1e-12);
}

TEST_CASE("constraint modes: supports and edges need modes that satisfy them") {
  const auto without_frame = [](std::string scene) {
    const std::size_t at = scene.find("    frame:");
    return scene.erase(at, scene.find('\n', at) + 1 - at);
  };
  CHECK_THROWS_WITH(
      move(without_frame(clamped_frame(clamped_beam, "type: support, between: [ground, b.end], hold: [z]",
                                       "type: force, at: {body: b, node: [1, 0, 0]}, force: [0, 0, 0.5]")),
           Formulation::vm_md),
      Catch::Contains("body b has a support") && Catch::Contains("expected of: joints"));
  CHECK_THROWS_WITH(
      move(without_frame(clamped_frame(clamped_plate, "type: revolute, between: [ground, b.right], axis: [0, 1, 0]",
                                       "type: pressure, body: b, pressure: 100")),
           Formulation::vm_md),
      Catch::Contains("joint root fixes 5 nodes of body b") && Catch::Contains("expected of: joints"));
}
