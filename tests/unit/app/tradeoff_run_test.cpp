#include "../../../src/app/tradeoff_run.h"

#include <map>

#include "../../../src/app/compare_table.h"
#include "../../../src/app/refined.h"
#include "command_tests.h"

using namespace floe::app;

namespace {

/// A cantilever whose tip goes to a tenth of its length, EI = L = rhoA = 1; or a linear one that spins up.
scene::Scene cantilever(const std::string& elements = "4", const std::string& frame = "pinned",
                        const std::string& motion = "end: 0.4, step: 0.02") {
  return at_equal_times(scene::parse_scene(
      "bodies:\n  beam:\n    mesh: {line: {from: [0, 0], to: [1, 0], elements: " + elements +
          "}}\n    section: {EA: 1e5, EI: 1, rhoA: 1}\n    frame: " + frame +
          "\n    reduction: {modes: 2}\njoints: {clamp: {type: fixed, between: [ground, beam.start]}}\n"
          "loads: {tip: {type: force, at: beam.end, force: [0, \"0.5*sin(2*t)\"]}}\nmotion: {" +
          motion + "}\nprobes: {tip: {at: beam.end}}\n",
      "scene.yaml"));
}

RunResult moved(const scene::Scene& scene, Formulation formulation) {
  RunPlan plan;
  plan.quiet = true, plan.check_range = false;
  return run(scene, formulation, PETSC_COMM_SELF, std::nullopt, plan);
}

/// nlffr in a quarter of the step stands for the reference.
TradeoffReference reference_of(const scene::Scene& scene) {
  TradeoffReference reference;
  scene::Scene fine = scene;
  fine.motion.step /= 4;
  reference.formulation = Formulation::nlffr, reference.series = moved(fine, Formulation::nlffr).series;
  return reference;
}

}  // namespace

TEST_CASE("trade-off: errors of members are those of simulations of their own, whatever becomes of them") {
  const scene::Scene scene = cantilever();
  const RunResult own = moved(scene, Formulation::nlffr);
  const TradeoffReference reference = reference_of(scene);
  TradeoffRequest request;
  scene::Scene longer = scene, shorter = scene, adaptive = scene, no_modes = scene;
  longer.motion.step *= 2;
  shorter.motion.end /= 2;
  adaptive.motion.tolerance = 1e-4;
  no_modes.bodies[0].reduction.modes.count = 400, no_modes.bodies[0].reduction.modes.given = true;
  const std::vector<Candidate> members = {{"scene", "own", scene, Formulation::vm_md},
                                          {"step", "longer", longer, Formulation::vm_md},
                                          {"step", "adaptive", adaptive, Formulation::vm_md},
                                          {"step", "shorter", shorter, Formulation::vm_md},
                                          {"modes", "too many", no_modes, Formulation::vm_md},
                                          {"full order", "longer nlffr", longer, Formulation::nlffr},
                                          {"cfr", "cfr", scene, Formulation::cfr},
                                          {"frames", "none", scene, Formulation::vm_md, 0, "not divisible\nat all"}};
  std::map<std::string, ModelVariant> all;
  for (const ModelVariant& one :
       TradeoffRun(scene, request, reference, own, "it is not", PETSC_COMM_WORLD).evaluate_all(members))
    all[one.name] = one;
  REQUIRE(all.size() == members.size());
  const Series reduced = moved(scene, Formulation::vm_md).series, full = moved(longer, Formulation::nlffr).series;
  CHECK(all["own"].total == vector_errors(reduced, reference.series));
  CHECK(all["own"].peak == peak_errors(reduced, reference.series));
  CHECK(all["own"].reduction == vector_errors(reduced, own.series));
  CHECK(all["own"].steps == 20);
  REQUIRE(all["own"].estimate.size() == 1);
  CHECK(all["own"].formulation == "vm+md");
  CHECK(all["longer nlffr"].total == vector_errors(full, reference.series));
  CHECK(all["longer nlffr"].reduction.empty());
  CHECK(all["longer"].reduction == vector_errors(moved(longer, Formulation::vm_md).series, full));
  CHECK(all["adaptive"].reduction.empty());  // no full-order model in the same steps
  CHECK(all["adaptive"].stopped.empty());
  CHECK(all["shorter"].stopped == "ends at t = 0.2 s instead of 0.4 s");
  CHECK_THAT(all["too many"].stopped, Contains("failed: ") && Contains("400"));
  CHECK(all["cfr"].stopped == "not simulated: it is not");
  CHECK(all["none"].stopped == "failed: not divisible");
  for (const auto& [name, one] : all) CHECK(one.stopped.empty() == std::isfinite(one.worst()));
}

TEST_CASE("trade-off: full-order models that would take too long are not simulated") {
  const scene::Scene scene = cantilever();
  const RunResult own = moved(scene, Formulation::nlffr);
  const TradeoffReference reference = reference_of(scene);
  TradeoffRequest request;
  request.most_seconds = 0;
  scene::Scene shorter = scene;
  shorter.motion.step /= 4;
  const std::vector<ModelVariant> all = TradeoffRun(scene, request, reference, own, "", PETSC_COMM_WORLD)
                                            .evaluate_all({{"full order", "nlffr", shorter, Formulation::nlffr},
                                                           {"full order", "lffr", scene, Formulation::lffr},
                                                           {"step", "shorter", shorter, Formulation::vm_md},
                                                           {"cfr", "cfr", scene, Formulation::cfr}});
  CHECK_THAT(all[0].stopped, Contains("not simulated: would take about") && Contains("(limit 0 s)"));
  CHECK(all[1].stopped.empty());  // as long as the scene's own
  CHECK(all[1].total == vector_errors(moved(scene, Formulation::lffr).series, reference.series));
  CHECK(all[2].stopped.empty());
  CHECK(all[2].reduction.empty());  // nor is the full-order model of a quarter of the step
  CHECK(all[3].stopped.empty());
}

TEST_CASE("trade-off: a model that diverges is a result") {
  // linear elastic forces in a rotating frame grow without limit beyond gamma = 3.516
  const auto spun = [](const std::string& end) {
    return at_equal_times(scene::parse_scene(R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 4}}
    section: {EA: 1e5, EI: 1, rhoA: 1}
    frame: {type: clamped, at: start}
    initial: {angular_velocity: 8}
    reduction: {modes: 2}
joints: {hub: {type: driven, between: [ground, beam.start], angle: "8*t"}}
loads: {tip: {type: force, at: beam.end, force: [0, 1e-3]}}
motion: {step: 0.01, end: )yaml" + end + "}\nprobes: {tip: {at: beam.end, quantity: deflection}}\n",
                                             "scene.yaml"));
  };
  const scene::Scene scene = spun("12");
  const RunResult own = moved(scene, Formulation::nlffr);
  TradeoffReference reference;
  reference.series = own.series;
  const auto all = TradeoffRun(scene, {}, reference, own, "", PETSC_COMM_WORLD)
                       .evaluate_all({{"full order", "lffr", scene, Formulation::lffr},
                                      {"full order", "short", spun("4"), Formulation::lffr}});
  CHECK_THAT(all[0].stopped, Contains("diverged at t = ") && Contains(" s"));
  CHECK_FALSE(all[1].stopped.empty());
}

TEST_CASE("trade-off: a selected model says what was selected, and its estimate") {
  const scene::Scene scene = cantilever("8");
  const RunResult own = moved(scene, Formulation::nlffr);
  const TradeoffReference reference = reference_of(scene);
  const auto all = TradeoffRun(scene, {}, reference, own, "", PETSC_COMM_WORLD)
                       .evaluate_all({{"accuracy", "selected for 10 %", scene, Formulation::vm_md, 0.1}});
  CHECK(all[0].stopped.empty());
  CHECK(all[0].required == 0.1);
  CHECK_THAT(all[0].selected, Contains("basis vectors; ") && Contains("step ") && Contains("elements in "));
  REQUIRE(all[0].estimate.size() == 1);
  CHECK(all[0].estimate[0] <= 0.1);
  CHECK(all[0].total[0] < 0.12);
}

TEST_CASE("trade-off: the reference is cfr where that is possible, else the full-order model with the reason") {
  const scene::Scene scene = cantilever("4", "mean-axis", "end: 0.1, step: 0.01");
  const Series own = moved(scene, Formulation::nlffr).series;
  const auto of = [&](const scene::Scene& one, const TradeoffRequest& request) {
    return tradeoff_reference(one, request, own, PETSC_COMM_WORLD);
  };
  const TradeoffReference exact = of(scene, {});
  CHECK(exact.formulation == Formulation::cfr);
  CHECK(exact.why.empty());
  CHECK_THAT(exact.words, Contains("cfr, elements 1/"));
  scene::Scene fine = scene;
  fine.bodies[0].mesh.elements = {16}, fine.motion.step /= 8;
  CHECK(worst_error(exact.series, moved(fine, Formulation::cfr).series) < 2e-3);

  TradeoffRequest request;
  request.reference = Formulation::nlffr;
  const TradeoffReference full = of(scene, request);
  CHECK(full.formulation == Formulation::nlffr);
  CHECK(full.why.empty());
  CHECK(full.words == "nlffr, elements 1/2 as long, steps 1/4 as long");
  CHECK(full.error_lacks == "the error of strains and floating frames");
  fine.bodies[0].mesh.elements = {8}, fine.motion.step = scene.motion.step / 4;
  CHECK(worst_error(full.series, moved(fine, Formulation::nlffr).series) < 1e-9);

  request.most_seconds = 0;  // cfr takes too long
  request.reference.reset();
  CHECK_THAT(of(scene, request).why, Contains("limit 0 s"));
  request.reference = Formulation::cfr;
  CHECK_THROWS_WITH(of(scene, request), Contains("--reference cfr: ") && Contains("--time-budget"));
  scene::Scene adaptive = scene;
  adaptive.motion.tolerance = 1e-4;
  request.reference = Formulation::nlffr;
  CHECK_THAT(of(adaptive, request).words, Contains("1/64 of the tolerance"));
}

// Of adaptive steps the tolerance has to fall with them: the error stated was a hundredth of the true one.
TEST_CASE("trade-off: the error of a reference in adaptive steps is the true one") {
  scene::Scene scene = cantilever("4", "mean-axis", "end: 0.5, step: 0.01, output: 0.01");
  const Series own = moved(scene, Formulation::nlffr).series;
  scene::Scene fine = scene;
  fine.bodies[0].mesh.elements = {24}, fine.motion.step /= 32;
  const Series exact = moved(fine, Formulation::cfr).series;
  scene.motion.tolerance = 1e-3;
  const TradeoffReference reference = tradeoff_reference(scene, {}, own, PETSC_COMM_WORLD);
  REQUIRE(reference.formulation == Formulation::cfr);
  CHECK_THAT(reference.words, Contains("of the tolerance"));
  const double error = worst_error(reference.series, exact);
  CAPTURE(error, reference.error, reference.words);
  CHECK(error < std::max(3 * reference.error, 1e-3));
}

TEST_CASE("trade-off: of a scene that an event ends, the reference is cfr, too") {
  const scene::Scene scene = scene::parse_scene(R"yaml(
gravity: [0, -9.81]
bodies:
  rod:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 4}}
    section: {EA: 1e5, EI: 5, rhoA: 0.5, rhoI: 1e-4}
    reduction: {modes: 3}
joints: {h: {type: revolute, between: [ground, rod.start]}}
motion: {end: 2, step: 4e-3}
events: {e: {stop: true, probe: tip.y, crosses: -0.9}}
probes: {tip: {at: rod.end, quantity: displacement}}
)yaml",
                                                "scene");
  const Series own = moved(scene, Formulation::nlffr).series;
  const TradeoffReference reference = tradeoff_reference(scene, {}, own, PETSC_COMM_WORLD);
  CHECK(reference.why.empty());
  CHECK(reference.formulation == Formulation::cfr);
  CHECK(reference.series.t.back() < 0.5);
  CHECK(worst_error(own, reference.series) < 0.01);
}

// At a level between the maxima of both meshes it ends the motion on one of them alone.
TEST_CASE("trade-off: cfr is no reference where an event ends its motion on one mesh and not on another") {
  scene::Scene scene = cantilever("2", "mean-axis", "end: 1.5, step: 0.01");
  const auto maximum = [&](int elements) {
    scene::Scene other = scene;
    other.bodies[0].mesh.elements = {elements};
    const Series series = moved(other, Formulation::cfr).series;
    const auto column = std::find_if(series.columns.begin(), series.columns.end(),
                                     [](const auto& one) { return one.name == "tip.y"; }) -
                        series.columns.begin();
    double greatest = 0;
    for (const auto& values : series.values) greatest = std::max(greatest, values[column]);
    return greatest;
  };
  scene.events.push_back({scene::Event::Kind::stop, "high", "", {}, {}, "tip.y", 0.5 * (maximum(2) + maximum(4)), {}});
  const Series own = moved(scene, Formulation::nlffr).series;
  const TradeoffReference reference = tradeoff_reference(scene, {}, own, PETSC_COMM_WORLD);
  CHECK(reference.formulation == Formulation::nlffr);
  CHECK_THAT(reference.why, Contains("with shorter elements at") && Contains("since an event ends it"));
}

TEST_CASE("trade-off: without probes there is nothing to compare, and no folder is left") {
  const OwnFolder own;
  scene::Scene scene = cantilever();
  scene.probes.clear();
  const std::string path = own.path / "out";
  CHECK_THROWS_WITH(printed([&] { tradeoff(scene, PETSC_COMM_WORLD, {}, path, false); }),
                    Contains("probes: there are none"));
  CHECK_FALSE(std::filesystem::exists(path));
}
