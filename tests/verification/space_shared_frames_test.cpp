#include <catch2/catch.hpp>

#include "space_twin.h"

using namespace floe;
using namespace floe::test;

namespace {

/// A panel, and a mast on the tip of it, on a hub that a moment rotates; `words` into the scene.
std::string hub(const std::string& words) {
  return words + R"yaml(
bodies:
  mast:
    rigid: true
    mesh: {line: {from: [0, 0, 0], to: [0, 0, 0.2], elements: 2}}
    section: {shape: rectangle, width: 0.05, height: 0.05, orientation: [1, 0, 0]}
    material: {E: 7e10, nu: 0.3, rho: 2700}
    initial: {position: [0.1, 0, 0]}
  hub:
    rigid: true
    mesh: {line: {from: [-0.1, 0, 0], to: [0.1, 0, 0], elements: 2}}
    section: {shape: rectangle, width: 0.2, height: 0.2, orientation: [0, 1, 0]}
    material: {E: 7e10, nu: 0.3, rho: 2700}
  panel:
    mesh: {plate: {along: [1, 0, 0], across: [0, 0.3, 0], elements: [6, 2]}}
    section: {thickness: 4e-3}
    material: {E: 3e9, nu: 0.3, rho: 1200}
    frame: {type: clamped, at: left}
    reduction: {modes: 5, derivatives: all}
    initial: {position: [0.1, "-0.15*cos(0.3)", "-0.15*sin(0.3)"], rotation: [0.3, 0, 0]}
joints:
  pivot: {type: revolute, between: [ground, {body: hub, node: [0, 0, 0]}], axis: [0, 0, 1]}
  weld: {type: fixed, between: [{body: hub, node: [0.1, 0, 0]}, {body: mast, node: [0, 0, 0]}]}
  root: {type: fixed, between: [{body: hub, node: [0.1, 0, 0]}, panel.left]}
loads: {drive: {type: moment, at: {body: hub, node: [0, 0, 0]}, moment: [0, 0, "8*sin(6*t)"]}}
gravity: [0, 0, -1]
motion: {end: 0.2, step: 1e-3}
probes:
  tip: {at: panel.right, quantity: position}
  bend: {at: panel.right, quantity: deflection}
  top: {at: {body: mast, node: [0, 0, 0.2]}, quantity: position}
)yaml";
}

}  // namespace

TEST_CASE("welded bodies: bodies fixed to a rigid one move as with frames of their own") {
  const History shared = move(hub(""), Formulation::nlffr), own = move(hub("share_frames: false"), Formulation::nlffr);
  for (const std::string probe : {"tip", "bend", "top"}) CHECK(apart(shared, own, probe) < 1e-6);
  const History reduced = move(hub(""), Formulation::vm_md);
  CHECK(apart(reduced, shared, "tip") < 1e-3);
  CHECK(apart(reduced, shared, "bend") < 0.02);
}

TEST_CASE("welded bodies: one frame for three bodies, and constraints of the pivot only") {
  const auto size = [](const std::string& words) {
    const assembly::Model model =
        assembly::build(scene::parse_scene(hub(words), "hub"), Formulation::vm_md, PETSC_COMM_WORLD);
    return std::array<PetscInt, 2>{model.coordinates, model.multipliers};
  };
  const auto [coordinates, multipliers] = size("");
  const auto [own, rows] = size("share_frames: false");
  CHECK(multipliers == 5);
  CHECK(coordinates == 6 + 20);
  CHECK(rows == 17);
  CHECK(own >= 18 + 20);
}
