#include "../../src/app/tradeoff.h"

#include <catch2/catch.hpp>
#include <map>

#include "../../src/app/discretisation.h"
#include "../../src/app/refined.h"
#include "../../src/app/tradeoff_run.h"
#include "scene_motion.h"

using namespace floe;
using namespace floe::test;

namespace {

const std::string cantilever = R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [100, 0], elements: $elements}}
    section: {A: 70, I: 585$more}
    material: {E: 16000, rho: 0.0078}
    reduction: {modes: 4}
joints: {clamp: {type: fixed, between: [ground, beam.start]}}
loads: {tip: {type: force, at: beam.end, force: [0, "4000*sin(9.5*t)"]}}
motion: {end: 0.6, step: $step, output: 4e-3}
probes: {tip: {at: beam.end}, middle: {at: beam.middle, quantity: deflection}}
)yaml";

scene::Scene scene_of(const char* elements, const char* step, const char* more = "") {
  return app::at_equal_times(
      scene::parse_scene(fill(cantilever, {{"elements", elements}, {"step", step}, {"more", more}}), "scene"));
}

/// Begins in a steady rotation, which cfr does not support in the plane.
scene::Scene rotating(const char* elements, const char* step) {
  std::string text = fill(cantilever, {{"elements", elements}, {"step", step}, {"more", ""}});
  const auto replace = [&](const std::string& old, const std::string& by) {
    text.replace(text.find(old), old.size(), by);
  };
  replace("type: fixed, between: [ground, beam.start]", "type: driven, angle: \"2*t\", between: [ground, beam.start]");
  replace("motion: {", "motion: {start: steady_rotation, ");
  return app::at_equal_times(scene::parse_scene(text, "scene"));
}

app::RunResult moved(const scene::Scene& scene, Formulation formulation) {
  app::RunPlan plan;
  plan.quiet = true, plan.check_range = false;
  return app::run(scene, formulation, PETSC_COMM_SELF, std::nullopt, plan);
}

/// Members of the hierarchy by their names.
std::map<std::string, app::ModelVariant> measured(const scene::Scene& scene, const app::TradeoffRequest& request,
                                                  const app::TradeoffReference& reference, const app::RunResult& own,
                                                  const std::vector<std::string>& names) {
  std::vector<app::Candidate> some;
  for (const app::Candidate& member : app::hierarchy(scene))
    if (std::find(names.begin(), names.end(), member.name) != names.end()) some.push_back(member);
  REQUIRE(some.size() == names.size());
  std::map<std::string, app::ModelVariant> all;
  for (const app::ModelVariant& variant :
       app::TradeoffRun(scene, request, reference, own, reference.why, PETSC_COMM_WORLD).evaluate_all(some))
    all[variant.name] = variant;
  return all;
}

}  // namespace

TEST_CASE("trade-off: totals are those against geometrically exact beams on a fine mesh in fine steps") {
  const app::Series exact = moved(scene_of("48", "1e-3"), Formulation::cfr).series;
  const scene::Scene scene = scene_of("8", "4e-3");
  const app::RunResult own = moved(scene, Formulation::nlffr);
  const app::TradeoffReference reference = app::tradeoff_reference(scene, {}, own.series, PETSC_COMM_WORLD);
  CHECK(reference.formulation == Formulation::cfr);
  CHECK(reference.why.empty());
  CHECK(reference.error < 2e-3);
  CHECK(app::worst_error(reference.series, exact) < 2e-3);
  const auto variants = measured(scene, {}, reference, own,
                                 {"the scene's own model", "1 mode + all MDs", "4 frames", "step 4x", "nlffr",
                                  "nlffr, 4 frames", "cfr", "cfr, twice the elements", "selected for 1 %"});
  for (const auto& [name, variant] : variants) {
    INFO(name << ": " << variant.stopped);
    CHECK(variant.stopped.empty());
    CHECK(variant.motion > 0);
  }
  // Total errors, by simulations of their own.
  app::Discretisation bodies = app::discretisation_of(scene);
  bodies[0].frames = 4;
  const scene::Scene in_frames = app::at_equal_times(app::discretised(scene, bodies));
  const app::Series nlffr_4 = moved(in_frames, Formulation::nlffr).series,
                    reduced_4 = moved(in_frames, Formulation::vm_md).series,
                    reduced = moved(scene, Formulation::vm_md).series;
  const std::pair<const char*, double> totals[] = {{"the scene's own model", app::worst_error(reduced, exact)},
                                                   {"4 frames", app::worst_error(reduced_4, exact)},
                                                   {"nlffr", app::worst_error(own.series, exact)},
                                                   {"nlffr, 4 frames", app::worst_error(nlffr_4, exact)}};
  for (const auto& [name, total] : totals) {
    INFO(name << ": " << variants.at(name).worst() << " against " << total);
    CHECK(variants.at(name).worst() == Approx(total).margin(2e-3));
  }
  CHECK(variants.at("nlffr").worst() > 0.02);  // one frame
  CHECK(variants.at("nlffr, 4 frames").worst() < 0.3 * variants.at("nlffr").worst());
  CHECK(variants.at("cfr").worst() < 0.05 * variants.at("nlffr").worst());  // what is left are mesh and step
  CHECK(variants.at("cfr, twice the elements").worst() < 2e-3);
  // The part due to the reduction, against the full-order model of the same frames.
  CHECK(variants.at("4 frames").reduction == app::vector_errors(reduced_4, nlffr_4));
  CHECK(variants.at("the scene's own model").reduction == app::vector_errors(reduced, own.series));
  CHECK(variants.at("1 mode + all MDs").reduction[0] > 5 * variants.at("the scene's own model").reduction[0]);
  CHECK(variants.at("step 4x").reduction.size() == 2);
  CHECK(variants.at("nlffr").reduction.empty());
  // Estimates without the reference.
  for (const char* name : {"the scene's own model", "4 frames", "step 4x", "selected for 1 %"}) {
    const app::ModelVariant& variant = variants.at(name);
    REQUIRE(variant.estimate.size() == 2);
    CHECK(variant.lacks.empty());
    const double estimate = *std::max_element(variant.estimate.begin(), variant.estimate.end());
    INFO(name << ": estimate " << estimate << ", true " << variant.worst());
    CHECK(estimate > 0.3 * variant.worst());
    CHECK(estimate < 3 * variant.worst());
  }
  CHECK(variants.at("selected for 1 %").worst() < 0.012);
  CHECK(variants.at("selected for 1 %").required == Approx(0.01));
  CHECK(variants.at("selected for 1 %").selected.find("frames") != std::string::npos);
}

TEST_CASE(
    "trade-off: where cfr is not supported, the reference is the full-order model on a finer mesh, with the reason") {
  const scene::Scene scene = rotating("8", "4e-3");
  const app::RunResult own = moved(scene, Formulation::nlffr);
  const app::TradeoffReference reference = app::tradeoff_reference(scene, {}, own.series, PETSC_COMM_WORLD);
  CHECK(reference.formulation == Formulation::nlffr);
  CHECK_THAT(reference.why, Catch::Contains("formulation cfr"));
  CHECK(reference.words == "nlffr, elements 1/2 as long, steps 1/4 as long");
  CHECK_THAT(reference.error_lacks, Catch::Contains("strains and floating frames"));
  const app::Series finer = moved(rotating("16", "1e-3"), Formulation::nlffr).series;
  CHECK(app::worst_error(reference.series, finer) < 1e-6);
  CHECK(reference.error == Approx(app::worst_error(own.series, finer) / 3).epsilon(1e-3));
  const auto variants = measured(scene, {}, reference, own, {"the scene's own model", "cfr"});
  CHECK_THAT(variants.at("cfr").stopped, Catch::StartsWith("not simulated: formulation cfr"));
  CHECK(variants.at("the scene's own model").lacks == "model");
  CHECK_THROWS_WITH(app::tradeoff_reference(scene, {Formulation::cfr, 0.01, 60}, own.series, PETSC_COMM_WORLD),
                    Catch::Contains("--reference cfr: formulation cfr"));
}

TEST_CASE("trade-off: the time budget decides between cfr and the full-order model") {
  const scene::Scene scene = scene_of("8", "4e-3");
  const app::RunResult own = moved(scene, Formulation::nlffr);
  const app::TradeoffRequest request{std::nullopt, 0.01, 1e-6};
  const app::TradeoffReference reference = app::tradeoff_reference(scene, request, own.series, PETSC_COMM_WORLD);
  CHECK(reference.formulation == Formulation::nlffr);
  CHECK_THAT(reference.why, Catch::Contains("would take about") && Catch::Contains("limit 1e-06 s"));
  const auto variants = measured(scene, request, reference, own, {"nlffr", "nlffr, twice the elements"});
  CHECK(variants.at("nlffr").stopped.empty());
  CHECK_THAT(variants.at("nlffr, twice the elements").stopped, Catch::StartsWith("not simulated: would take about"));
}
