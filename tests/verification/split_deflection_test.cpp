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

namespace {

scene::Scene free_beam(const std::string& text, const std::string& kind, int frames) {
  return scene::parse_scene(
      fill(text, {{"kind", kind}, {"count", std::to_string(frames)}, {"modes", std::to_string(frames > 1 ? 4 : 6)}}),
      "scene");
}

Eigen::VectorXd at_start(const scene::Scene& scene, Formulation formulation) {
  const assembly::Model model = assembly::build(scene, formulation, PETSC_COMM_SELF);
  const std::vector<double> values = assembly::probe_values(model, 0, model.U, model.V);
  return Eigen::Map<const Eigen::VectorXd>(values.data(), std::ssize(values));
}

app::Series full_order_motion(const scene::Scene& scene) {
  app::RunPlan plan;
  plan.quiet = true, plan.check_range = false;
  return app::run(scene, Formulation::nlffr, PETSC_COMM_SELF, std::nullopt, plan).series;
}

void check_frames(const std::string& text, const Eigen::VectorXd& clamped_at_start) {
  for (const std::string kind : {"pinned", "clamped", "mean-axis"}) {
    const scene::Scene whole = free_beam(text, kind, 1);
    const Eigen::VectorXd one = at_start(whole, Formulation::nlffr);
    if (kind == "clamped") CHECK((one - clamped_at_start).norm() < 1e-9);
    CHECK(one.norm() > 1e-3);
    for (const int frames : {2, 4}) {
      INFO(kind << ", " << frames << " frames");
      const scene::Scene split = free_beam(text, kind, frames);
      for (const auto formulation : {Formulation::nlffr, Formulation::vm_md})
        CHECK((at_start(split, formulation) - one).norm() < 2e-3 * one.norm());
      if (kind != "clamped")  // whose motions from a deformation need far shorter steps
        CHECK(app::worst_error(full_order_motion(split), full_order_motion(whole)) < 2e-2);
    }
  }
}

}  // namespace

// A free beam bent by an inextensible deformation, in the world's axes rotated and moved.
TEST_CASE("deflections of a body in several frames begin with the initial deformation, in every kind of frame") {
  check_frames(R"yaml(
bodies:
  beam:
    mesh: {line: {from: [1, 2], to: [2, 2], elements: 16}}
    section: {A: 1.0e-4, I: 1.0e-9}
    material: {E: 2.0e+11, rho: 7800}
    frame: {type: $kind}
    frames: $count
    reduction: {modes: $modes}
    initial: {deformation: ["-6.6666667e-5*(x-1)^3", "0.01*(x-1)^2"], angle: 0.7, angular_velocity: 2}
motion: {end: 0.02, step: 1e-4}
probes: {tip: {at: beam.end, quantity: deflection}, middle: {at: beam.middle, quantity: deflection}}
)yaml",
               Eigen::Vector4d(-6.6666667e-5, 0.01, -6.6666667e-5 / 8, 0.0025));
}

TEST_CASE("in space, deflections of a body in several frames are from the frame of the whole body") {
  check_frames(
      R"yaml(
bodies:
  beam:
    mesh: {line: {from: [1, 2, 0.5], to: [2, 2, 0.5], elements: 16}}
    section: {A: 1.0e-4, Iy: 1.0e-9, Iz: 2.0e-9, J: 2.0e-9, orientation: [0, 1, 0], centroid: [2e-3, 1e-3]}
    material: {E: 2.0e+11, nu: 0.3, rho: 7800}
    frame: {type: $kind}
    frames: $count
    reduction: {modes: $modes}
    initial:
      deformation: ["-6.6666667e-5*(x-1)^3 - 3.24e-5*(x-1)^5", "0.01*(x-1)^2", "0.006*(x-1)^3"]
      rotation: [0.3, 0.2, 0.5]
      angular_velocity: [1, 2, -1]
motion: {end: 0.02, step: 1e-4}
probes: {tip: {at: beam.end, quantity: deflection}, middle: {at: beam.middle, quantity: deflection}}
)yaml",
      (Eigen::VectorXd(6) << -6.6666667e-5 - 3.24e-5, 0.01, 0.006, -6.6666667e-5 / 8 - 3.24e-5 / 32, 0.0025, 0.006 / 8)
          .finished());
}

TEST_CASE("a load in the axes of a body in several frames is reported") {
  const std::string text = R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 8}}
    section: {A: 1.0e-4, I: 1.0e-9}
    material: {E: 2.0e+11, rho: 7800}
    frames: $count
    reduction: {modes: 2}
joints: {clamp: {type: fixed, between: [ground, beam.start]}}
loads: {tip: {type: force, at: beam.end, force: [0, 1], axes: body}}
motion: {end: 1, step: 0.1}
)yaml";
  const auto warnings = [&](const std::string& frames) {
    return assembly::build(scene::parse_scene(fill(text, {{"count", frames}}), "scene"), Formulation::vm_md,
                           PETSC_COMM_SELF)
        .warnings;
  };
  CHECK(warnings("1").empty());
  REQUIRE(warnings("4").size() == 1);
  CHECK_THAT(warnings("4").front(), Catch::Contains("load tip") && Catch::Contains("axes: place or world"));
}
