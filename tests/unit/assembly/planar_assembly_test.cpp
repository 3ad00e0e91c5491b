#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>

#include "building.h"
#include "floe/solve/simulation.h"
#include "floe/solve/start.h"

using namespace floe;
using scene::Formulation;
using testing::all_formulations;
using testing::at_start;
using testing::built;
using testing::complaint;

namespace {

const std::string beam = R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [2, 0], elements: 6}}
    section: {EA: 1e4, EI: 10, rhoA: 3, rhoI: 0.1}
    reduction: {modes: 3}
)yaml";
const std::string motion = "motion: {end: 0.1, step: 0.01}\nprobes:\n  tip: {at: beam.end, quantity: displacement}\n";

/// Greatest violation of the joints at a level.
double violation(const assembly::Model& model, dynamics::ConstraintLevel level) {
  return solve::constraint_violation(*model.system, 0, model.U, model.V, level);
}

}  // namespace

TEST_CASE("coordinates and multipliers of each formulation") {
  const std::string text = beam + "joints:\n  hinge: {type: revolute, between: [ground, beam.start]}\n" + motion;
  const assembly::Model cfr = built(text, Formulation::cfr), full = built(text, Formulation::nlffr),
                        reduced = built(text, Formulation::vm_md);
  CHECK(cfr.coordinates == 21);
  CHECK(full.coordinates == 24);
  CHECK(reduced.coordinates == 3 + reduced.bodies[0].columns);
  for (const assembly::Model* model : {&cfr, &full, &reduced}) CHECK(model->multipliers == 2);
}

TEST_CASE("joints hold at the start: a moving body takes the nearest velocities that they allow") {
  const std::string joint =
      GENERATE("{type: revolute, between: [ground, beam.start]}", "{type: fixed, between: [ground, beam.middle]}",
               "{type: prismatic, between: [ground, beam.start], axis: [1, 2]}",
               "{type: driven, between: [ground, beam.start], angle: \"0.5*t + t^2\"}");
  std::string text = beam + "    initial: {position: [1, 1], angle: 0.4, velocity: [1, 0.2], angular_velocity: 2}\n" +
                     "joints:\n  j: " + joint + "\n" + motion;
  for (const auto formulation : all_formulations()) {
    INFO(joint << " " << scene::name_of(formulation));
    const assembly::Model model = built(text, formulation);
    CHECK(violation(model, dynamics::ConstraintLevel::position) < 1e-13);
    CHECK(violation(model, dynamics::ConstraintLevel::velocity) < 1e-12);
    CHECK(model.velocity_correction > 0.01);
  }
}

TEST_CASE("a falling body has gravity's acceleration; a distributed load adds its share, in every formulation") {
  const std::string text = beam + R"yaml(
gravity: [0, -10]
loads:
  wind: {type: distributed, body: beam, force: [6, 0]}
)yaml" + motion;
  for (const auto formulation : all_formulations()) {
    INFO(scene::name_of(formulation));
    assembly::Model model = built(text, formulation);
    solve::simulate(*model.system, {0.1, 0.01, 0.8, {}}, model.U, model.V, [](const solve::Instant&) {});
    const auto tip = at_start(model);
    CHECK(tip[0] == Approx(0.5 * 2 * 0.01).epsilon(1e-6));
    CHECK(tip[1] == Approx(-0.5 * 10 * 0.01).epsilon(1e-6));
  }
}

TEST_CASE("forces of body axes are given in the axes of the mesh") {
  // the frame runs from end to start: its x axis points backwards
  const std::string text = beam + R"yaml(
    rigid: true
    frame: {type: pinned, from: end, to: start}
    initial: {angle: pi/2}
loads:
  push: {type: force, at: beam.middle, force: [6, 0], axes: body}
)yaml" + motion;
  assembly::Model model = built(text, Formulation::nlffr);
  solve::simulate(*model.system, {0.1, 0.01, 0.8, {}}, model.U, model.V, [](const solve::Instant&) {});
  const auto tip = at_start(model);  // a mass of 6 pushed along the beam, which stands upright
  CHECK(std::abs(tip[0]) < 1e-12);
  CHECK(tip[1] == Approx(0.5 * 0.01).epsilon(1e-9));
}

TEST_CASE("what cannot be built is told with its place in the file") {
  using Catch::Contains;
  const std::string apart =
      beam + "joints:\n  j: {type: revolute, between: [{body: ground, node: [0, 1]}, beam.start]}\n" + motion;
  const std::string driven =
      beam + "joints:\n  j: {type: driven, between: [ground, beam.start], angle: 1 + t}\n" + motion;
  const std::string modal = beam + "    damping: {modal: [0.01]}\n" + motion;
  const std::string rayleigh = beam + "    damping: {mass: 0.1}\n" + motion;
  const std::string follower = beam + "loads:\n  f: {type: force, at: beam.end, force: [1, 0], axes: body}\n" + motion;
  for (const auto formulation : all_formulations()) {
    CHECK_THAT(complaint(apart, formulation), Contains("test.yaml:8") && Contains("1 apart"));
    CHECK_THAT(complaint(driven, formulation), Contains("test.yaml:8") && Contains("is 1 at t = 0"));
  }
  CHECK(complaint(modal, Formulation::cfr).empty());
  CHECK(complaint(modal, Formulation::nlffr).empty());
  CHECK(complaint(modal, Formulation::vm_md).empty());
  CHECK(complaint(rayleigh, Formulation::cfr).empty());
  CHECK(complaint(rayleigh, Formulation::nlffr).empty());
  CHECK(complaint(follower, Formulation::cfr).empty());
  CHECK(complaint(follower, Formulation::lffr).empty());
}

TEST_CASE("a prismatic joint lets its body slide along the axis and nowhere else") {
  const std::string text = beam + R"yaml(
    rigid: true
    initial: {angle: 0.3}
joints:
  rail: {type: prismatic, between: [ground, beam.start], axis: [3, 4]}
loads:
  push: {type: force, at: beam.start, force: [10, 0]}
)yaml" + motion;
  assembly::Model model = built(text, Formulation::vm);
  solve::simulate(*model.system, {0.1, 0.01, 0.8, {}}, model.U, model.V, [](const solve::Instant&) {});
  const auto tip = at_start(model);
  const double along = 0.5 * (10 * 0.6 / 6) * 0.01;
  CHECK(tip[0] == Approx(0.6 * along).epsilon(1e-9));
  CHECK(tip[1] == Approx(0.8 * along).epsilon(1e-9));
}

TEST_CASE("a spring without a length is unstretched at the start") {
  const std::string text = beam + R"yaml(
joints:
  spring: {type: spring, between: [{body: ground, node: [0, 1]}, beam.end], stiffness: 100, torsional_stiffness: 7}
)yaml" + motion;
  for (const auto formulation : all_formulations()) {
    const assembly::Model model = built(text, formulation);
    CHECK(std::abs(model.system->energy(0, model.U, model.V).elastic) < 1e-20);
  }
}

TEST_CASE("a drive is 0 at the start by its own size") {
  const auto told = [](const std::string& angle) {
    return testing::complaint(
        beam + "joints: {j: {type: driven, between: [ground, beam.start], angle: \"" + angle + "\"}}\n" + motion,
        scene::Formulation::nlffr);
  };
  CHECK(told("1e-12*cos(t)").find("is 1e-12 at t = 0") != std::string::npos);
  CHECK(told("1e-12*sin(t)") == "");
  CHECK(told("sin(t) + 1e-11*cos(t)") == "");  // round-off of numbers that are written down
  CHECK(told("sin(t) + 1e-9").find("at t = 0") != std::string::npos);
}

TEST_CASE("joints hold at the start: a drive's rate that is round-off of its formula is no change of velocities") {
  const auto correction = [](const std::string& angle) {
    const std::string text =
        beam + "joints: {j: {type: driven, between: [ground, beam.start], angle: \"" + angle + "\"}}\n" + motion;
    return built(text, Formulation::nlffr).velocity_correction;
  };
  CHECK(correction("0.2*t^1.5") == 0);
  CHECK(correction("0.2*t^1.5 + 1e-4*t") == 1);
}

TEST_CASE("joints hold at the start: velocities of any size") {
  for (const double size : {1e-14, 1e-30}) {
    const std::string text = beam + fmt::format("    initial: {{velocity: [{0}, {1}]}}\n", size, 0.3 * size) +
                             "joints: {j: {type: revolute, between: [ground, beam.start]}}\n" + motion;
    const assembly::Model model = built(text, scene::Formulation::nlffr);
    CHECK(violation(model, dynamics::ConstraintLevel::velocity) < 1e-12 * size);
    CHECK(model.velocity_correction > 0.01);
  }
}
