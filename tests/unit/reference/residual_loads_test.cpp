#include "floe/assembly/residual_loads.h"

#include <catch2/catch.hpp>

#include "floe/assembly/kept_motion.h"
#include "floe/assembly/offline.h"
#include "floe/scene/scene.h"
#include "floe/solve/simulation.h"

using namespace floe;
using Catch::Matchers::WithinAbs;

namespace {

// A damped shell in mean axes that swings about a hinge line on a rotating arm of beams, and a plate that the ground
// clamps: every kind of full-order element, of moving and fixed-frame bodies.
const char* const scene_text = R"(
gravity: [0, 0, -9.81]
bodies:
  arm:
    mesh: {line: {from: [0, 0, 0], to: [0.5, 0, 0], elements: 4}}
    section: {shape: rectangle, width: 0.02, height: 0.01, orientation: [0, 0, 1]}
    material: {E: 7e10, nu: 0.3, rho: 2700}
    reduction: {modes: 2, derivatives: all}
    damping: {stiffness: 1e-4}
  flap:
    mesh: {plate: {along: [0.3, 0, 0], across: [0, 0.2, 0], elements: [3, 2]}}
    section: {thickness: 2e-3}
    material: {E: 7e10, nu: 0.3, rho: 2700}
    frame: mean-axis
    reduction: {modes: 2, derivatives: all}
    damping: {stiffness: 1e-4}
    initial: {position: [0.5, 0, 0]}
  board:
    mesh: {plate: {along: [0.3, 0, 0], across: [0, 0.2, 0], elements: [3, 2]}}
    section: {thickness: 2e-3}
    material: {E: 7e10, nu: 0.3, rho: 2700}
    frame: {type: clamped, at: left}
    reduction: {modes: 2, derivatives: all}
    damping: {stiffness: 1e-4}
    initial: {position: [0, 1, 0]}
joints:
  root: {type: driven, between: [ground, arm.start], axis: [0, 0, 1], angle: "2*t^2 + 0.5*t"}
  hinge: {type: revolute, between: [arm.end, flap.p1], axis: [0, 1, 0]}
  wall: {type: fixed, between: [ground, board.left]}
motion: {end: 0.1, step: 1e-3}
probes:
  tip: {at: flap.p3, quantity: displacement}
)";

}  // namespace

TEST_CASE("residuals of elements that are made for each evaluation are those of stored ones") {
  const scene::Scene scene = scene::parse_scene(scene_text, "scene");
  const assembly::Model model = assembly::build(scene, scene::Formulation::vm_md, PETSC_COMM_WORLD, true);
  assembly::KeptMotion kept(model);
  const solve::Integration how{scene.motion.end, scene.motion.step, scene.motion.spectral_radius, {}};
  solve::simulate(*model.system, how, model.U, model.V, [&](const solve::Instant& at) { kept.keep(at); });
  const std::vector<solve::State> states = assembly::spread(kept.states(), 3);
  assembly::Residuals stored(model, *model.offline), apart(model, *model.offline, 0);
  REQUIRE_FALSE(stored.apart());
  REQUIRE(apart.apart());
  stored.add(states), apart.add(states);
  for (std::size_t b = 0; b < 3; ++b) {
    INFO("body " << b);
    REQUIRE(apart.loads(b).size() == states.size());
    for (std::size_t i = 0; i < states.size(); ++i) {
      double size = 0, difference = 0;
      petsc::check(VecNorm(stored.loads(b)[i].load, NORM_2, &size));
      REQUIRE(size > 0);
      petsc::check(VecAXPY(apart.loads(b)[i].load, -1, stored.loads(b)[i].load));
      petsc::check(VecNorm(apart.loads(b)[i].load, NORM_2, &difference));
      CHECK_THAT(difference / size, WithinAbs(0, 1e-9));
    }
  }
  CHECK_THAT(apart.unbalanced(), WithinAbs(stored.unbalanced(), 1e-9));
}
