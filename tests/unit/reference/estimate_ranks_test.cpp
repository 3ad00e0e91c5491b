#include <catch2/catch.hpp>

#include "floe/assess/estimate.h"
#include "floe/solve/start.h"
#include "scene_motion.h"

using namespace floe;
using namespace floe::test;

namespace {

/// Clamped at an edge, loaded at a corner.
std::string plate(int along, int across) {
  return fill(R"yaml(
bodies:
  plate:
    mesh: {plate: {along: [2, 0, 0], across: [0, 1, 0], elements: [$along, $across]}}
    section: {thickness: 0.02}
    material: {E: 7e10, nu: 0.3, rho: 2700}
    reduction: {modes: 2}
joints: {root: {type: fixed, between: [ground, plate.left]}}
loads: {corner: {type: force, at: plate.p3, force: [0, 0, "600*t"]}}
motion: {end: 0.02, step: 1e-3}
probes: {tip: {at: plate.p3}}
)yaml",
              {{"along", std::to_string(along)}, {"across", std::to_string(across)}});
}

/// Two members in a line, of one element each.
const char* const arms = R"yaml(
bodies:
  a:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 1}}
    section: {EA: 1e4, EI: 1, rhoA: 1}
    reduction: {modes: 1}
  b:
    mesh: {line: {from: [1, 0], to: [2, 0], elements: 1}}
    section: {EA: 1e4, EI: 1, rhoA: 1}
    reduction: {modes: 1}
joints:
  root: {type: fixed, between: [ground, a.start]}
  weld: {type: fixed, between: [a.end, b.start]}
loads: {tip: {type: force, at: b.end, force: [0, "0.1*t"]}}
motion: {end: 0.02, step: 1e-3}
probes: {tip: {at: b.end}}
)yaml";

assess::Estimate of_motion(const std::string& text, MPI_Comm comm) {
  const scene::Scene scene = scene::parse_scene(text, "scene");
  assembly::Model model = assembly::build(scene, Formulation::vm, comm, true);
  assess::KeptMotion kept(model);
  solve::simulate(*model.system, {scene.motion.end, scene.motion.step, scene.motion.spectral_radius, {}}, model.U,
                  model.V, [&](const solve::Instant& at) { kept.keep(at); });
  return assess::estimate_error(model, kept, 100);
}

assess::Estimate of_equilibrium(const std::string& text, MPI_Comm comm) {
  assembly::Model model = assembly::build(scene::parse_scene(text, "scene"), Formulation::vm, comm, true);
  solve::equilibrium(*model.system, 1, model.U, model.V);
  return assess::estimate_error_at_rest(model, {solve::state_of(*model.system, 1, model.U, model.V, model.V)}, 100);
}

void same(const assess::Estimate& all, const assess::Estimate& one) {
  REQUIRE(all.none == "");
  REQUIRE(one.none == "");
  CHECK(all.deformation > 0);
  CHECK(all.deformation == Approx(one.deformation).epsilon(1e-6));
  REQUIRE(all.probes.size() == one.probes.size());
  for (std::size_t i = 0; i < all.probes.size(); ++i) CHECK(all.probes[i] == Approx(one.probes[i]).epsilon(1e-6));
}

}  // namespace

TEST_CASE("the estimate is that of one rank where others own no dofs: from fewer elements than ranks") {
  const std::string text = GENERATE(plate(1, 1), plate(2, 1), plate(3, 2), std::string(arms));
  INFO(text);
  same(of_motion(text, PETSC_COMM_WORLD), of_motion(text, PETSC_COMM_SELF));
  same(of_equilibrium(text, PETSC_COMM_WORLD), of_equilibrium(text, PETSC_COMM_SELF));
}
