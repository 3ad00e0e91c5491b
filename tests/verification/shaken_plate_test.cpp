#include <catch2/catch.hpp>

#include "scene_motion.h"

using namespace floe;
using namespace floe::test;

namespace {

const std::string scene_text = R"yaml(
bodies:
  plate:
    mesh: {plate: {along: [2, 0, 0], across: [0, 1, 0], elements: [8, 4]}}
    section: {thickness: 0.02}
    material: {E: 7e10, nu: 0.3, rho: 2700}
    reduction: {modes: 6}
joints: {root: {type: fixed, between: [ground, plate.left]}}
loads: {corner: {type: force, at: plate.p3, force: [0, 0, "600*sin(24*t)"]}}
motion: {end: 0.3, step: 2e-3}
probes: {tip: {at: plate.p3}}
)yaml";

}  // namespace

// Ten per cent of the length at the corner: the plate must draw in to bend, and only derivatives let it.
TEST_CASE("shaken plate: modes with derivatives agree with the full-order shells, modes alone do not") {
  const History full = move(scene_text, Formulation::nlffr), reduced = move(scene_text, Formulation::vm_md),
                modes = move(scene_text, Formulation::vm);
  CHECK(relative_error(reduced, full, "tip.z") < 0.01);
  CHECK(relative_error(reduced, full, "tip.x") < 0.02);
  CHECK(relative_error(modes, full, "tip.z") > 0.5);
}
