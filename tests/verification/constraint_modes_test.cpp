#include <catch2/catch.hpp>

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

// The end clamped, the start rotated by the drive: all six dofs of the ends are told, the shape between is the body's.
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
