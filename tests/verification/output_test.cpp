#include <catch2/catch.hpp>

#include "../../src/app/compare_table.h"
#include "../../src/app/run.h"
#include "scene_motion.h"

using namespace floe;
using namespace floe::test;

namespace {

app::Series moved(const std::string& text, const std::string& motion, Formulation formulation) {
  app::RunPlan plan;
  plan.quiet = true, plan.check_range = false;
  const scene::Scene scene = scene::parse_scene(text + "motion: {end: 0.5, " + motion + "}\n", "scene");
  return app::run(scene, formulation, PETSC_COMM_WORLD, std::nullopt, plan).series;
}

/// What is stored between steps errs by no more than what is stored at their ends.
void check_output(const std::string& text, Formulation formulation) {
  const app::Series exact = moved(text, "step: 2.5e-4, every: 4", formulation);
  const app::Series at_steps = moved(text, "step: 4e-3", formulation);
  const app::Series between = moved(text, "step: 4e-3, output: 1e-3", formulation);
  REQUIRE(between.t.size() == 501);
  CHECK(between.t[3] == Approx(3e-3));
  const double error = app::worst_error(at_steps, exact);
  INFO("at the ends of steps " << error << ", between them, too, " << app::worst_error(between, exact));
  CHECK(error > 1e-7);
  CHECK(app::worst_error(between, exact) < 1.1 * error);
  for (std::size_t i = 0; i < at_steps.t.size(); ++i)  // nothing changes in the motion
    for (std::size_t c = 0; c < at_steps.columns.size(); ++c)
      CHECK(between.values[4 * i][c] == Approx(at_steps.values[i][c]).epsilon(1e-12).margin(1e-12));
}

}  // namespace

TEST_CASE("output: between steps, in the plane") {
  const std::string pendulum = R"yaml(
gravity: [0, -9.81]
bodies:
  rod:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 8}}
    section: {EA: 1.2e3, EI: 0.5, rhoA: 1}
    reduction: {modes: 2}
joints: {hinge: {type: revolute, between: [ground, rod.start]}}
probes: {tip: {at: rod.end, quantity: position}, rate: {at: rod.end, quantity: velocity}}
)yaml";
  check_output(pendulum, Formulation::vm_md);
  check_output(pendulum, Formulation::nlffr);
}

TEST_CASE("output: between steps, of a tumbling body in space") {
  check_output(R"yaml(
bodies:
  box:
    rigid: true
    mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: 1}}
    section: {shape: rectangle, width: 0.5, height: 0.2, orientation: [0, 1, 0]}
    material: {E: 1e9, nu: 0.3, rho: 1000}
    initial: {angular_velocity: [4, 6, 9], velocity: [1, 0, 0]}
probes: {corner: {at: {body: box, node: [1, 0.2, 0.1]}, quantity: position}, rate: {at: box.end, quantity: velocity}}
)yaml",
               Formulation::vm_md);
}

TEST_CASE("output: adaptive steps are stored at equal intervals") {
  const std::string text = R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 8}}
    section: {EA: 1.2e4, EI: 1, rhoA: 1}
    reduction: {modes: 2}
joints: {clamp: {type: fixed, between: [ground, beam.start]}}
loads: {tip: {type: force, at: beam.end, force: [0, "0.5*sin(9*t)"]}}
probes: {tip: {at: beam.end}}
)yaml";
  const app::Series series = moved(text, "step: 1e-3, tolerance: 1e-5, output: 0.01", Formulation::vm_md);
  REQUIRE(series.t.size() == 51);
  for (std::size_t i = 0; i < series.t.size(); ++i) CHECK(series.t[i] == Approx(0.01 * static_cast<double>(i)));
  CHECK(app::worst_error(series, moved(text, "step: 2.5e-4", Formulation::vm_md)) < 1e-3);
}

TEST_CASE("output: the instant at which an event ends the motion is stored, at any interval") {
  const std::string fall = R"yaml(
gravity: [0, -9.81]
bodies:
  mass: {rigid: {mass: 1, centre: [0, 0], inertia: 1}}
events: {low: {stop: true, $what}}
probes: {c: {at: mass.centre, quantity: position}}
)yaml";
  const double end = std::sqrt(2 * 0.5 / 9.81);
  for (const std::string what : {"probe: c.y, crosses: -0.5", "at: 0.31927542840705"})
    for (const std::string interval : {"step: 1e-3", "step: 1e-3, every: 7", "step: 1e-3, output: 0.01",
                                       "step: 1e-3, output: 0.01, tolerance: 1e-4"}) {
      CAPTURE(what, interval);
      const app::Series series = moved(fill(fall, {{"what", what}}), interval, Formulation::vm_md);
      CHECK(series.t.back() == Approx(end).epsilon(1e-9));
      CHECK(series.values.back()[1] == Approx(-0.5).epsilon(1e-6));
      CHECK(*std::prev(series.t.end(), 2) < end - 1e-6);  // once
    }
}
