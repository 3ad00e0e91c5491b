#include <catch2/catch.hpp>

#include "../../src/app/compare_table.h"
#include "../../src/app/run.h"
#include "scene_motion.h"

using namespace floe;
using namespace floe::test;

// Small deflections, so that frames do not change the strains.
TEST_CASE("deflections of a body in several frames are from the frame of the whole body") {
  const std::string text = R"yaml(
bodies:
  beam:
    mesh: {line: {from: [1, 2], to: [81, 62], elements: 8}}
    section: {A: 70, I: 585}
    material: {E: 16000, rho: 0.0078}
    frame: {type: $kind}
    frames: $count
    reduction: {modes: 4}
joints: {clamp: {type: fixed, between: [ground, beam.start]}}
loads: {tip: {type: force, at: beam.end, force: ["-12*sin(9.5*t)", "16*sin(9.5*t)"]}}
motion: {end: 0.4, step: 4e-3}
probes: {middle: {at: beam.middle, quantity: deflection}}
)yaml";
  for (const std::string kind : {"pinned", "clamped"}) {
    const auto series = [&](const std::string& frames, Formulation formulation) {
      app::RunPlan plan;
      plan.quiet = true, plan.check_range = false;
      const scene::Scene scene = scene::parse_scene(fill(text, {{"kind", kind}, {"count", frames}}), "scene");
      return app::run(scene, formulation, PETSC_COMM_SELF, std::nullopt, plan).series;
    };
    const app::Series one = series("1", Formulation::nlffr);
    CHECK(app::worst_error(series("2", Formulation::nlffr), one) < 2e-3);
    CHECK(app::worst_error(series("4", Formulation::nlffr), one) < 2e-3);
    CHECK(app::worst_error(series("2", Formulation::vm_md), one) < 1e-2);
    CHECK(app::worst_error(series("2", Formulation::cfr), one) < 5e-3);
  }
}
