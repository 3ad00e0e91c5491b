#include "floe/assess/step_error.h"

#include <catch2/catch.hpp>

#include "estimated.h"

using namespace floe;
using namespace floe::test;

namespace {

struct Moved {
  History history;
  assess::StepError error;
};

/// A reduced motion with the error of its step, found in so much time (as multiples of what the motion takes).
Moved move_with_step_error(const std::string& text, double allowed) {
  const scene::Scene scene = scene::parse_scene(text, "scene");
  Moved all{{assembly::build(scene, Formulation::vm_md, PETSC_COMM_WORLD, true), {}, {}, {}, {}}, {}};
  const assembly::Model& model = all.history.model;
  const solve::Integration how{scene.motion.end, scene.motion.step, scene.motion.spectral_radius, {}};
  const solve::State start = assess::start_of(model);
  assess::KeptMotion kept(model);
  solve::simulate(*model.system, how, model.U, model.V, [&](const solve::Instant& at) {
    store(all.history, at.t, at.U, at.V);
    kept.keep(at);
  });
  all.error = assess::estimate_step_error(model, start, kept, how, 1, allowed);
  return all;
}

/// Against an eighth of the step: a factor of three either way.
void check_step(const std::string& text, const std::string& step, const std::string& fine, double allowed) {
  const Moved coarse = move_with_step_error(fill(text, {{"step", step}}), allowed);
  const History reference_motion = move(fill(text, {{"step", fine}}), Formulation::vm_md);
  REQUIRE(coarse.error.none == "");
  CHECK(coarse.error.halved == (allowed >= 2));
  REQUIRE(coarse.error.probes.size() == coarse.history.model.probes.size());
  for (std::size_t p = 0; p < coarse.error.probes.size(); ++p) {
    const std::string& probe = coarse.history.model.probes[p].name;
    const double error = vector_error(coarse.history, reference_motion, probe), estimate = coarse.error.probes[p];
    INFO(fmt::format("{} allowed {}: error {:.3g}, estimate {:.3g}", probe, allowed, error, estimate));
    CHECK(estimate > 0.3 * error);
    CHECK(estimate < 3 * error);
  }
}

const char* const pendulum = R"yaml(
gravity: [0, -9.81]
bodies:
  rod:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 8}}
    section: {EA: 1.2e4, EI: 1, rhoA: 1}
    reduction: {modes: 3, derivatives: all}
joints: {hinge: {type: revolute, between: [ground, rod.start]}}
motion: {end: 1, step: $step}
probes: {tip: {at: rod.end, quantity: position}, middle: {at: rod.middle, quantity: deflection}}
)yaml";

const char* const rotating_arm = R"yaml(
gravity: [0, 0, -9.81]
bodies:
  arm:
    mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: 6}}
    section: {A: 0.002, Iy: 1e-6, Iz: 2e-6, J: 3e-6, orientation: [0, 0, 1]}
    material: {E: 1e8, nu: 0.3, rho: 1000}
    reduction: {modes: 3, derivatives: all}
    initial: {angular_velocity: [0, 0, 9]}
joints: {hub: {type: spherical, between: [ground, arm.start]}}
motion: {end: 0.5, step: $step}
probes: {tip: {at: arm.end, quantity: position}}
)yaml";

}  // namespace

TEST_CASE("error of the step: half and twice the step give it within a factor of three") {
  const double allowed = GENERATE(2., 1.);
  check_step(pendulum, "4e-3", "5e-4", allowed);
  check_step(rotating_arm, "4e-3", "5e-4", allowed);
}

TEST_CASE("error of the step: with a small time budget from the first part only, and none for adaptive steps") {
  const Moved part = move_with_step_error(fill(pendulum, {{"step", "4e-3"}}), 0.25);
  REQUIRE(part.error.none == "");
  CHECK_FALSE(part.error.halved);
  CHECK(part.error.until == Approx(0.5).margin(0.01));
}
