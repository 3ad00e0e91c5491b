#include <catch2/catch.hpp>

#include "estimated.h"
#include "floe/assess/budget.h"
#include "floe/petsc/rank.h"

using namespace floe;
using namespace floe::test;

namespace {

struct Budget {
  History history;
  assess::ErrorPart model, mesh;
  assess::StepError step;
  std::vector<double> total;
};

/// A reduced motion with all parts of its error, found in so much processor time each [s].
Budget budget_of(const std::string& text, double allowed) {
  const scene::Scene scene = scene::parse_scene(text, "scene");
  Budget all{{assembly::build(scene, Formulation::vm_md, PETSC_COMM_WORLD, true), {}, {}, {}, {}}, {}, {}, {}, {}};
  const assembly::Model& model = all.history.model;
  solve::Integration how{scene.motion.end, scene.motion.step, scene.motion.spectral_radius, {}};
  const solve::State start = assess::start_of(model);
  assess::KeptMotion kept(model);
  all.history.report = solve::simulate(*model.system, how, model.U, model.V, [&](const solve::Instant& at) {
    store(all.history, at.t, at.U, at.V);
    kept.keep(at);
  });
  const assess::Estimate estimate = assess::of_whole(assess::estimate_error(model, kept, 100), kept);
  const assess::FinishedMotion motion{scene, model, start, how, all.history.report.steps, 0.1, 0.1, PETSC_COMM_WORLD};
  const assess::ProbeSeries own = assess::probe_series(model, kept, estimate);
  all.step = assess::estimate_step_error(model, start, kept, how, 0.1, allowed);
  assess::ErrorPart reduction, step;
  reduction.probes = estimate.probes, reduction.t = estimate.t, reduction.errors = estimate.errors;
  step.none = all.step.none;
  step.probes = all.step.probes, step.t = all.step.t, step.errors = all.step.errors;
  all.mesh = assess::estimate_mesh_error(motion, own, allowed);
  all.model = assess::estimate_model_error(motion, own, estimate, all.mesh, allowed);
  std::vector<const assess::ErrorPart*> parts = {&step, &all.mesh};
  if (estimate.none.empty()) parts.push_back(&reduction);
  if (all.model.none.empty()) parts.push_back(&all.model);
  all.total = assess::total_error(own, parts);
  return all;
}

/// A reduced motion, for parts of its error.
struct Reduced {
  explicit Reduced(const std::string& text)
      : scene(scene::parse_scene(text, "scene")),
        model(assembly::build(scene, Formulation::vm_md, PETSC_COMM_WORLD, true)),
        how{scene.motion.end, scene.motion.step, scene.motion.spectral_radius, {}},
        start(assess::start_of(model)),
        kept(model) {
    report = solve::simulate(*model.system, how, model.U, model.V, [&](const solve::Instant& at) { kept.keep(at); });
    estimate = assess::estimate_error(model, kept, 100);
    own = assess::probe_series(model, kept, assess::of_whole(estimate, kept));
  }
  /// Of which other models are those of another scene.
  assess::FinishedMotion motion(const scene::Scene& other) const {
    return {other, model, start, how, report.steps, 0.1, 0.1, PETSC_COMM_WORLD};
  }

  scene::Scene scene;
  assembly::Model model;
  solve::Integration how;
  solve::State start;
  assess::KeptMotion kept;
  solve::IntegrationReport report;
  assess::Estimate estimate;
  assess::ProbeSeries own;
};

/// Corotational elements, on every rank by itself: small systems on several ranks are slow.
History exact_motion(const std::string& text) {
  const scene::Scene scene = scene::parse_scene(text, "scene");
  History history{assembly::build(scene, Formulation::cfr, PETSC_COMM_SELF), {}, {}, {}, {}};
  const solve::Integration how{scene.motion.end, scene.motion.step, scene.motion.spectral_radius, {}};
  history.report = solve::simulate(*history.model.system, how, history.model.U, history.model.V,
                                   [&](const solve::Instant& at) { store(history, at.t, at.U, at.V); });
  return history;
}

/// The total against corotational elements a quarter as long in a quarter of the step.
void check_total(const std::string& text, const std::string& elements, const std::string& step,
                 const std::string& fine_elements, const std::string& fine_step, double allowed = 100) {
  const Budget budget = budget_of(fill(text, {{"elements", elements}, {"step", step}}), allowed);
  const History exact = exact_motion(fill(text, {{"elements", fine_elements}, {"step", fine_step}}));
  REQUIRE(budget.model.none == "");
  REQUIRE(budget.mesh.none == "");
  REQUIRE(budget.step.none == "");
  CHECK(budget.model.apart == (allowed > 1));
  REQUIRE(budget.total.size() == budget.history.model.probes.size());
  for (std::size_t p = 0; p < budget.total.size(); ++p) {
    const std::string& probe = budget.history.model.probes[p].name;
    const double error = vector_error(budget.history, exact, probe), total = budget.total[p];
    INFO(fmt::format("{}: error {:.4g}, total {:.4g} of model {:.3g}, mesh {:.3g}, step {:.3g} ({})", probe, error,
                     total, budget.model.probes[p], budget.mesh.probes[p], budget.step.probes[p], budget.model.by));
    CHECK(error > 1e-3);
    CHECK(total > 0.3 * error);
    CHECK(total < 3 * error);
  }
}

const char* const cantilever = R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [100, 0], elements: $elements}}
    section: {A: 70, I: 585}
    material: {E: 16000, rho: 0.0078}
    frame: {type: pinned, from: start, to: end}
    reduction: {modes: 4, derivatives: all}
joints: {clamp: {type: fixed, between: [ground, beam.start]}}
loads: {tip: {type: force, at: beam.end, force: [0, "2500*sin(9.5*t)"]}}
motion: {end: 1.5, step: $step}
probes: {tip: {at: beam.end}, middle: {at: beam.middle, quantity: deflection}}
)yaml";

const char* const rod_in_space = R"yaml(
gravity: [0, 0, -9.81]
bodies:
  rod:
    mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: $elements}}
    section: {shape: rectangle, width: 0.02, height: 0.005, orientation: [0, 1, 0]}
    material: {E: 2e9, nu: 0.3, rho: 1200}
    frame: pinned
    reduction: {modes: 4, derivatives: all}
joints: {root: {type: fixed, between: [ground, rod.start]}}
loads: {tip: {type: force, at: rod.end, force: [0, "0.05*sin(5*t)", 0]}}
motion: {end: 0.4, step: $step}
probes: {tip: {at: rod.end}}
)yaml";

std::string plate(const std::string& quantity, const std::string& frame = "{type: clamped, at: left}",
                  const std::string& root = "left") {
  return fill(R"yaml(
bodies:
  plate:
    mesh: {plate: {along: [2, 0, 0], across: [0, 1, 0], elements: [4, 2]}}
    section: {thickness: 0.02}
    material: {E: 7e10, nu: 0.3, rho: 2700}
    frame: $frame
    reduction: {modes: 3}
joints: {root: {type: fixed, between: [ground, plate.$root]}}
loads: {corner: {type: force, at: plate.p3, force: [0, 0, "600*sin(24*t)"]}}
motion: {end: 0.1, step: 2e-3}
probes: {tip: {at: plate.p3, quantity: $quantity}}
)yaml",
              {{"quantity", quantity}, {"frame", frame}, {"root", root}});
}

}  // namespace

TEST_CASE("error budget: the total is that of the answer, in the plane and in space") {
  check_total(cantilever, "8", "4e-3", "32", "1e-3");
  check_total(rod_in_space, "8", "4e-3", "32", "1e-3");
}

TEST_CASE("error budget: what cannot be estimated says why") {
  const Budget deflection = budget_of(plate("deflection", "mean-axis", "p1"), 100);
  CHECK(deflection.mesh.none == "");
  CHECK(deflection.model.none == "");
  CHECK(deflection.model.notes.empty());
  const Budget fixed = budget_of(plate("deflection"), 100), moved = budget_of(plate("displacement"), 100);
  CHECK(fixed.model.none == "");  // the frame is fixed to the ground: both probes are the same
  CHECK(fixed.model.probes.at(0) == Approx(moved.model.probes.at(0)).epsilon(1e-6));
  const Budget late = budget_of(plate("displacement"), 1e-3), at_once = budget_of(plate("displacement"), 1e-6);
  CHECK_THAT(late.model.none, Catch::Contains("formulation cfr would take about"));
  CHECK_THAT(at_once.model.none, Catch::Contains("formulation cfr would take more than"));  // not even built
}

TEST_CASE("error budget: parts of a beginning are added by size") {
  const assess::ProbeSeries own{{{"tip.x", "m", 1}}, {1, 2, 3, 4}, {{1.}, {1.}, {1.}, {1.}}};
  assess::ErrorPart all, opposite, beginning;
  all.t = opposite.t = own.t;
  all.errors = {{.3}, {.3}, {.3}, {.3}}, opposite.errors = {{-.1}, {-.1}, {-.1}, {-.1}};
  beginning.t = {1, 2}, beginning.errors = {{.1}, {.1}}, beginning.probes = {.1};
  CHECK(assess::total_error(own, {&all, &opposite}).at(0) == Approx(.2));
  CHECK(assess::total_error(own, {&all, &opposite, &beginning}).at(0) == Approx(.3));
  opposite.probes = {.1};
  CHECK(assess::total_error(own, {&all}, {&opposite}).at(0) == Approx(std::hypot(.3, .1)));
}

// A force that begins at half the time: the equations of the error of two modes diverge soon after. What is known until
// then is no error of the motion, and the part of the model contains that of the reduction.
TEST_CASE("error budget: equations of the error that diverge before the motion ends") {
  const std::string slide = R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: $elements}}
    section: {EA: 1e6, EI: 10, rhoA: 1}
    reduction: {modes: 2}
joints: {c: {type: prismatic, between: [ground, beam.start], axis: [0, 1]}}
loads: {f: {type: force, at: beam.end, force: [0, "600*(t > 0.5)"]}}
motion: {end: 0.9, step: $step}
probes: {tip: {at: beam.end}}
)yaml";
  const std::string text = fill(slide, {{"elements", "10"}, {"step", "2e-3"}});
  const Reduced one(text);
  const assess::Estimate reduction = assess::of_whole(one.estimate, one.kept);
  REQUIRE(one.estimate.none == "");
  CHECK(one.estimate.t.back() < 0.8);
  CHECK_THAT(reduction.none, Catch::Contains("of 0.9 s: the equations of the error diverge at t = "));
  CHECK(reduction.t.empty());
  const Budget budget = budget_of(text, 100);
  CHECK(budget.model.with_reduction);
  const History exact = exact_motion(fill(slide, {{"elements", "20"}, {"step", "5e-4"}}));
  const double error = vector_error(budget.history, exact, "tip");
  INFO(fmt::format("error {:.3g}, total {:.3g}", error, budget.total.at(0)));
  CHECK(budget.total[0] > 0.5 * error);
  CHECK(budget.total[0] < 2 * error);
}

TEST_CASE("error budget: the model contains the mesh where the mesh error covers less") {
  const Reduced one(fill(cantilever, {{"elements", "8"}, {"step", "4e-3"}}));
  assess::ErrorPart mesh = assess::estimate_mesh_error(one.motion(one.scene), one.own, 100);
  const auto model = [&] {
    return assess::estimate_model_error(one.motion(one.scene), one.own, one.estimate, mesh, 100);
  };
  CHECK(model().apart);
  mesh.errors.resize(mesh.errors.size() / 2);
  CHECK_FALSE(model().apart);
}

namespace {

const std::string spinning = R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: $elements}}
    section: {EA: 2e5, EI: 20, rhoA: 1}
    reduction: {modes: 3, derivatives: all}
    initial: {angular_velocity: 10}
joints: {hinge: {type: revolute, between: [ground, beam.start]}}
loads: {tip: {type: force, at: beam.end, force: [0, "20*(t>0.1)"]}}
motion: {end: 1, step: $step}
probes: {tip: {at: beam.end}}
)yaml";

}  // namespace

// Steps of 0.1 rad: twice as long, they move the tip of formulation cfr by more than both models differ.
TEST_CASE("error budget: the model part is that of shorter steps where its own do not resolve it") {
  const Budget fine = budget_of(fill(spinning, {{"elements", "4"}, {"step", "2e-3"}}), 100),
               coarse = budget_of(fill(spinning, {{"elements", "4"}, {"step", "1e-2"}}), 100);
  CHECK(fine.model.notes.empty());
  CHECK(fine.model.probes[0] < 0.01);
  INFO(coarse.model.probes[0]);
  CHECK_THAT(coarse.model.by, Catch::Contains("and both in steps 1/"));
  CHECK(coarse.model.notes.empty());
  CHECK(coarse.model.probes[0] < 3 * fine.model.probes[0]);
  const History exact = exact_motion(fill(spinning, {{"elements", "16"}, {"step", "5e-4"}}));
  const double error = vector_error(coarse.history, exact, "tip");
  CHECK(error > 0.01);
  CHECK(coarse.total[0] > 0.3 * error);
  CHECK(coarse.total[0] < 3 * error);
}

// The torque of formulation cfr in these steps is wrong by 160 %; in a hundredth of them it is that of the motion.
// Steps twice as long fail.
TEST_CASE("error budget: a difference of both models that no step resolves is left out") {
  const Budget budget = budget_of(R"yaml(
gravity: [0, 0, -9.81]
bodies:
  hub: {rigid: {mass: 2, centre: [0, 0, 0], inertia: [0.01, 0.01, 0.02]}}
  blade:
    mesh: {line: {from: [0.1, 0, 0], to: [1.1, 0.15, 0.05], elements: 12}}
    section: {shape: rectangle, width: 0.04, height: 0.005, orientation: [0, 1, 0.2]}
    material: {E: 4e10, nu: 0.3, rho: 1800}
    reduction: {modes: 5}
joints:
  shaft: {type: driven, between: [ground, hub.centre], axis: [0, 0, 1], angle: 20*t}
  root: {type: fixed, between: [{body: hub, node: [0.1, 0, 0]}, blade.start]}
loads:
  gust: {type: force, at: blade.end, force: [0, 0, "6*smooth(t,0.05,0.2)*(1-smooth(t,0.2,0.4))"], axes: place}
motion: {end: 0.6, step: 0.008, start: steady_rotation}
probes:
  torque: {joint: shaft, quantity: drive}
  tip: {at: blade.end, quantity: position, relative_to: blade.start}
)yaml",
                                  100);
  CHECK_THAT(budget.model.by, Catch::EndsWith("and both in steps 1/4 as long"));
  REQUIRE(budget.model.notes.size() == 1);
  CHECK_THAT(budget.model.notes[0], Catch::Contains("torque is left out"));
  CHECK(std::isnan(budget.model.probes[0]));
  CHECK(std::isnan(budget.model.errors.back()[0]));
  CHECK(budget.model.probes[1] < 1e-4);  // 0.039 % in the steps of the motion
}

// 10 selected vectors of 30 dofs: those of the same names on the refined mesh move by 80 % less.
TEST_CASE("error budget: the mesh of a model with selected basis vectors is refined at full order") {
  const std::string text = R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 4}}
    section: {A: 1e-4, I: 1e-9}
    material: {E: 7e10, rho: 2700}
    frames: 2
    reduction:
      modes: 4
      attachment: all
      columns: ["#1 mode 2", "#1 mode 4", "#1 attachment beam#1-2.fx", "#2 mode 2", "#2 mode 4", "#1 derivative 1,beam#1-2.fx",
                "#1 derivative 4,4", "#1 derivative 4,beam#1-2.fx", "#2 derivative 2,4", "#2 derivative 3,tip.fx"]
joints: {clamp: {type: fixed, between: [ground, beam.start]}}
loads: {tip: {type: force, at: beam.end, force: [0, 25*sin(30*t)]}}
motion: {end: 0.4, step: 2e-3}
probes: {tip: {at: beam.end}}
)yaml";
  const Reduced one(text);
  const assess::ErrorPart mesh = assess::estimate_mesh_error(one.motion(one.scene), one.own, 100);
  REQUIRE(mesh.none == "");
  CHECK_THAT(mesh.by, Catch::Contains("full-order"));
  std::string fine = text;
  fine.replace(fine.find("elements: 4"), 11, "elements: 16");
  const double error = vector_error(move(text, Formulation::nlffr), move(fine, Formulation::nlffr), "tip");
  CHECK(mesh.probes[0] > 0.3 * error);
  CHECK(mesh.probes[0] < 3 * error);
}

// End load F L^2/(EI) = 2 at t = 1: the tip moves by half the length, where one pinned frame is in error.
TEST_CASE("error budget: equilibria have parts for model and mesh") {
  const std::string beam = R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [2, 0], elements: $elements}}
    section: {EA: 4e4, EI: 3, rhoA: 1}
    reduction: {modes: 4, derivatives: all}
joints: {clamp: {type: fixed, between: [ground, beam.start]}}
loads: {tip: {type: force, at: beam.end, force: [0, "1.5*t"]}}
probes: {tip: {at: beam.end}}
)yaml";
  const int steps = 4;
  const auto equilibria = [&](const assembly::Model& model, const auto& at) {
    for (int i = 1; i <= steps; ++i) {
      const double t = double(i) / steps;
      solve::equilibrium(*model.system, t, model.U, model.V);
      at(solve::Instant{t, i, model.U, model.V, model.V, i == steps});
    }
  };
  const scene::Scene scene = scene::parse_scene(fill(beam, {{"elements", "4"}}), "scene");
  Estimated one{{assembly::build(scene, Formulation::vm_md, PETSC_COMM_WORLD, true), {}, {}, {}, {}}, {}};
  History exact{
      assembly::build(scene::parse_scene(fill(beam, {{"elements", "32"}}), "scene"), Formulation::cfr, PETSC_COMM_SELF),
      {},
      {},
      {},
      {}};
  const assembly::Model& model = one.history.model;
  assess::KeptMotion kept(model);
  equilibria(model, [&](const solve::Instant& at) {
    store(one.history, at.t, at.U, at.V);
    kept.keep(at);
  });
  equilibria(exact.model, [&](const solve::Instant& at) { store(exact, at.t, at.U, at.V); });
  one.estimate = assess::estimate_error_at_rest(model, kept.states(), 100);
  const assess::ProbeSeries own = assess::probe_series(model, kept, one.estimate);
  const solve::State start;
  solve::Integration how;
  how.end = 1, how.step = 1. / steps;
  const assess::FinishedMotion motion{scene, model, start, how, steps, 0.1, 0.1, PETSC_COMM_WORLD, true};
  const assess::ErrorPart mesh = assess::estimate_mesh_error(motion, own, 100),
                          part = assess::estimate_model_error(motion, own, one.estimate, mesh, 100);
  CHECK(mesh.none == "");
  CHECK(part.none == "");
  CHECK(part.apart);
  CHECK(mesh.until == 1);
  assess::ErrorPart reduction;
  reduction.probes = one.estimate.probes, reduction.t = one.estimate.t, reduction.errors = one.estimate.errors;
  const double total = assess::total_error(own, {&reduction, &mesh, &part}).at(0),
               error = vector_error(one.history, exact, "tip");
  INFO(fmt::format("reduction {:.3g}, mesh {:.3g}, model {:.3g}, total {:.3g}, true {:.3g}", reduction.probes[0],
                   mesh.probes[0], part.probes[0], total, error));
  CHECK(error > 0.005);
  CHECK(total == Approx(error).epsilon(0.2));
}

// Every rank has its own copy of small models; what fails on one of them must not leave the others waiting.
TEST_CASE("error budget: a fault of one rank is that of all ranks") {
  const std::string good = fill(cantilever, {{"elements", "8"}, {"step", "4e-3"}});
  std::string stops = good, refused = good;
  stops.replace(stops.find("2500"), 4, "(t > 0.9 ? 1e40 : 2500)");
  const std::string motion = "motion: {";
  refused.replace(refused.find(motion), motion.size(), "motion: {start: steady_rotation, ");
  const Reduced one(good);
  int size = 1;
  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  const auto on_last = [&](const std::string& text) {
    return scene::parse_scene(petsc::rank_of(PETSC_COMM_WORLD) == size - 1 ? text : good, "scene");
  };
  const scene::Scene stopping = on_last(stops), refusing = on_last(refused);
  const assess::ErrorPart mesh = assess::estimate_mesh_error(one.motion(stopping), one.own, 100);
  CHECK(mesh.none == "");
  REQUIRE(mesh.notes.size() == 1);
  CHECK_THAT(mesh.notes[0],
             Catch::Contains("elements half as long") && Catch::Contains("the simulation stopped at t = 0.9"));
  CHECK(mesh.until > 0.8);
  CHECK(mesh.until < 0.91);
  const assess::ErrorPart model = assess::estimate_model_error(one.motion(stopping), one.own, one.estimate, mesh, 100);
  CHECK(model.none == "");
  CHECK(model.until == Approx(mesh.until).margin(0.0081));  // in one of the first steps of 4e-3 under the force
  CHECK_THAT(assess::estimate_model_error(one.motion(refusing), one.own, one.estimate, mesh, 100).none,
             Catch::Contains("is steady_rotation"));
}

TEST_CASE("scaled meshes: generated ones, as whole numbers of elements") {
  scene::Scene scene = scene::parse_scene(plate("displacement"), "scene");
  CHECK(assess::scale_meshes(scene, 2));
  CHECK(scene.bodies[0].mesh.plate->elements == std::array<int, 2>{8, 4});
  CHECK(assess::scale_meshes(scene, 0.25));
  CHECK_FALSE(assess::scale_meshes(scene, 0.5));
}

// A corner of a single triangle: with all its mass at one point, translations and drilling rotation had no mass.
TEST_CASE("corotational shells: every node has mass in all directions") {
  std::string fine = plate("displacement");
  fine.replace(fine.find("[4, 2]"), 6, "[16, 8]");
  fine.replace(fine.find("end: 0.1"), 8, "end: 0.01");
  const History history = exact_motion(fine);
  CHECK(history.report.steps == 5);
}
