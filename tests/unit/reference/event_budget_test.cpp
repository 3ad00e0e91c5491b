#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <catch2/catch.hpp>

#include "estimated.h"
#include "floe/assess/budget.h"

using namespace floe;
using namespace floe::test;

namespace {

/// A reduced motion whose events change joints, with all parts of its error.
struct Switched {
  explicit Switched(const std::string& text)
      : scene(scene::parse_scene(text, "scene")),
        history{assembly::build(scene, Formulation::vm_md, PETSC_COMM_WORLD, true), {}, {}, {}, {}},
        how{scene.motion.end, scene.motion.step, scene.motion.spectral_radius, {}},
        start(assess::start_of(history.model)),
        kept(history.model) {
    const assembly::Model& model = history.model;
    how.events = assembly::events_of(scene, model, how.end);
    how.on_event = [&](const dynamics::EventReport& event) { history.events.push_back(event), kept.note(event); };
    history.report = solve::simulate(*model.system, how, model.U, model.V, [&](const solve::Instant& at) {
      if (history.t.empty() || at.t > history.t.back()) store(history, at.t, at.U, at.V, at.A);  // before an event
      kept.keep(at);
    });
    own = assess::probe_series(model, kept, {});
  }
  /// Of which other models are those of another scene.
  assess::FinishedMotion motion(const scene::Scene& other) const {
    return {other, history.model, start, how, history.report.steps, 0.1, 0.1, PETSC_COMM_WORLD};
  }

  scene::Scene scene;
  History history;
  solve::Integration how;
  solve::State start;
  assess::KeptMotion kept;
  assess::ProbeSeries own;
};

/// Bent by a force that has ended, it is released: at a time, or where its tip passes a height.
const char* const bent = R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: $elements}}
    section: {A: 1e-4, I: 2.1e-10}
    material: {E: 2e9, rho: 1000}
    frame: {type: pinned, from: start, to: end}
    damping: {stiffness: 1e-2}
    reduction: {modes: 3, derivatives: all}
joints: {clamp: {type: fixed, between: [ground, beam.start]}}
loads: {tip: {type: force, at: beam.end, force: [0, "0.3*smooth(t,0,0.5)"]}}
motion: {end: 0.8, step: $step}
events: {off: {unlock: clamp, $when}}
probes: {tip: {at: beam.end}, root: {at: beam.start, quantity: velocity}, held: {joint: clamp, quantity: force}}
)yaml";

const char* const swing = R"yaml(
gravity: [0, -9.81]
bodies:
  rod:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: $elements}}
    section: {EA: 1.2e4, EI: 4, rhoA: 1}
    damping: {stiffness: 2e-3}
    reduction: {modes: 3, derivatives: all}
joints: {hinge: {type: revolute, between: [ground, rod.start]}}
motion: {end: 0.7, step: $step}
events: {catch: {lock: hinge, $when}}
probes: {tip: {at: rod.end, quantity: position}, speed: {at: rod.end, quantity: velocity}}
)yaml";

const char* const bent_in_space = R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: $elements}}
    section: {A: 1e-4, Iy: 2.1e-10, Iz: 4.2e-10, J: 5e-10, orientation: [0, 1, 0]}
    material: {E: 2e9, nu: 0.3, rho: 1000}
    frame: {type: pinned, from: start, to: end}
    damping: {stiffness: 1e-3}
    reduction: {modes: 4, derivatives: all}
joints: {clamp: {type: fixed, between: [ground, beam.start]}}
loads: {tip: {type: force, at: beam.end, force: [0, "0.4*smooth(t,0,0.3)*(1-smooth(t,0.3,0.5))", "0.3*smooth(t,0,0.3)*(1-smooth(t,0.3,0.5))"]}}
motion: {end: 0.7, step: $step}
events: {off: {unlock: clamp, $when}}
probes: {tip: {at: beam.end}, root: {at: beam.start, quantity: velocity}}
)yaml";

std::string scene_of(const char* text, const std::string& when, const std::string& elements, const std::string& step) {
  return fill(text, {{"when", when}, {"elements", elements}, {"step", step}});
}

/// All parts of the error, and their total.
struct Parts {
  assess::Estimate full;
  assess::ErrorPart reduction, model, mesh, step;
  std::vector<double> total;

  explicit Parts(const Switched& moved) {
    const assess::FinishedMotion motion = moved.motion(moved.scene);
    full = assess::estimate_by_full_order(motion, moved.own, 100);
    reduction.none = full.none, reduction.probes = full.probes, reduction.t = full.t, reduction.errors = full.errors;
    mesh = assess::estimate_mesh_error(motion, moved.own, 100);
    model = assess::estimate_model_error(motion, moved.own, full, mesh, 100);
    const assess::StepError steps =
        assess::estimate_step_error(moved.history.model, moved.start, moved.kept, moved.how, 0.1, 100);
    step.none = steps.none, step.probes = steps.probes, step.t = steps.t, step.errors = steps.errors;
    total = assess::total_error(moved.own, {&reduction, &mesh, &model, &step});
  }
};

}  // namespace

// Against corotational elements a quarter as long in an eighth of the step.
TEST_CASE("error budget: parts and total of a motion whose joints change", "[long]") {
  struct Case {
    const char* text;
    std::string when;
  };
  for (const Case& one : {Case{bent, "at: 0.6"}, Case{bent, "probe: tip.y, crosses: 0.15"}, Case{swing, "at: 0.4"},
                          Case{bent_in_space, "at: 0.55"}}) {
    const Switched moved(scene_of(one.text, one.when, "8", "2e-3"));
    const History exact = move(scene_of(one.text, one.when, "32", "2.5e-4"), Formulation::cfr);
    const assess::FinishedMotion motion = moved.motion(moved.scene);
    const auto [full, reduction, model, mesh, step, total] = Parts(moved);
    for (const std::string& none : {full.none, mesh.none, model.none, step.none}) CHECK(none == "");
    CHECK_THAT(full.by, Catch::StartsWith("formulation nlffr, same mesh"));
    CHECK_FALSE(model.with_reduction);
    CHECK(model.by.find(", steps 1/") == std::string::npos);  // their steps resolve what the release sets free
    for (std::size_t p = 0; p < total.size(); ++p) {
      const std::string& probe = moved.history.model.probes[p].name;
      if (probe == "held" && one.when != "at: 0.6") continue;  // it jumps at another time in the exact motion
      const double error = vector_error(moved.history, exact, probe);
      INFO(fmt::format("{} {}: error {:.4g}, total {:.4g} of reduction {:.3g}, model {:.3g}, mesh {:.3g}, step {:.3g}",
                       one.when, probe, error, total[p], reduction.probes[p], model.probes[p], mesh.probes[p],
                       step.probes[p]));
      CHECK(error > 5e-4);
      CHECK(total[p] > 0.3 * error);
      CHECK(total[p] < 3 * error);
    }
    CHECK(assess::estimate_model_error(motion, moved.own, {}, mesh, 100).with_reduction);
  }
}

// Without damping the release sets vibrations free that the steps do not resolve, in either model alike: the part of
// the step is nearly the whole. Where one model alone was extrapolated to steps of no length, parts of model and step
// cancelled in the total (0.3 of the error).
TEST_CASE("error budget: the total where steps resolve neither model", "[long]") {
  const char* const arms = R"yaml(
gravity: [0, -9.81]
bodies:
  a:
    mesh: {line: {from: [0, 0], to: [0.8, 0], elements: $elements}}
    section: {A: 4e-4, I: 1e-8}
    material: {E: 7e10, rho: 2700}
    reduction: {modes: 4}
  b: {like: a, initial: {position: [0.8, 0], angle: 0.5}}
joints:
  shoulder: {type: revolute, between: [ground, a.start]}
  elbow: {type: revolute, between: [a.end, b.start]}
  tip: {type: revolute, between: [ground, b.end]}
motion: {end: 0.6, step: $step}
events: {drop: {unlock: tip, $when}}
probes:
  angle: {joint: elbow, quantity: angle}
  rate: {joint: elbow, quantity: rate}
  tip: {at: b.end, quantity: position}
)yaml";
  const Switched moved(scene_of(arms, "at: 0.1234", "8", "5e-4"));
  const History exact = move(scene_of(arms, "at: 0.1234", "16", "6.25e-5"), Formulation::cfr);
  const auto [full, reduction, model, mesh, step, total] = Parts(moved);
  for (std::size_t p = 0; p < total.size(); ++p) {
    const std::string& probe = moved.history.model.probes[p].name;
    const double error = vector_error(moved.history, exact, probe);
    INFO(fmt::format("{}: error {:.4g}, total {:.4g} of reduction {:.3g}, model {:.3g}, mesh {:.3g}, step {:.3g}",
                     probe, error, total[p], reduction.probes[p], model.probes[p], mesh.probes[p], step.probes[p]));
    CHECK(total[p] > 0.5 * error);
    CHECK(total[p] < 2 * error);
  }
}

// Corotational elements do not converge behind the release of a beam that is bent so far, in a quarter of the step
// either.
TEST_CASE("error budget: a part ends where a better model stops behind an event") {
  std::string text = scene_of(bent, "at: 0.6", "32", "8e-3");
  for (const auto& [from, to] : {std::pair{"0.3*smooth", "30*smooth"}, {"1e-2", "1e-5"}, {"end: 0.8", "end: 0.7"}})
    text.replace(text.find(from), std::string(from).size(), to);
  const Switched moved(text);
  CHECK_THROWS_AS(move(text, Formulation::cfr), solve::MotionStopped);
  const assess::ErrorPart model = assess::estimate_model_error(moved.motion(moved.scene), moved.own, {}, {}, 100);
  CHECK(model.none == "");
  CHECK_THAT(model.by, Catch::StartsWith("formulation cfr, same mesh"));
  CHECK(model.until == Approx(0.6));
  REQUIRE(model.notes.size() >= 3);
  INFO(fmt::format("{}", fmt::join(model.notes, "\n")));
  CHECK_THAT(model.notes.front(), Catch::Contains("the simulation stopped at t = 0.6 of 0.7"));
  const auto has = [&](const char* words) {
    return std::any_of(model.notes.begin(), model.notes.end(),
                       [&](const std::string& note) { return note.find(words) != std::string::npos; });
  };
  CHECK(has("root moves later than t = 0.6 s"));
}

// After the motion the joint is open: what it carried before must be that of the motion all the same.
TEST_CASE("error budget: probes before and after an event are those of the motion") {
  const Switched moved(scene_of(bent, "at: 0.6", "8", "4e-3"));
  REQUIRE(moved.own.t.size() + 1 == moved.history.t.size());
  const std::size_t columns = moved.own.columns.size();
  REQUIRE(moved.own.columns[columns - 1].name == "held.y");
  double before = 0;
  for (std::size_t i = 0; i < moved.own.t.size(); ++i) {
    for (std::size_t c = 0; c < columns; ++c)
      CHECK(moved.own.values[i][c] == moved.history[moved.own.columns[c].name][i + 1]);
    if (moved.own.t[i] <= 0.6) before = moved.own.values[i][columns - 1];
  }
  CHECK(std::abs(before) > 0.2);  // at the instant of the event itself
  CHECK(moved.own.values.back()[columns - 1] == 0);
}

// The clamp's force jumps from up to 0.3 N to zero: between the times of the event in both models it is not compared.
TEST_CASE("error budget: between the times of an event in both models nothing is compared") {
  const Switched moved(scene_of(bent, "probe: tip.y, crosses: 0.15", "8", "4e-3"));
  REQUIRE(moved.history.events.size() == 1);
  scene::Scene later = moved.scene;
  later.events[0].crosses = 0.18;
  const assess::ErrorPart part = assess::estimate_mesh_error(moved.motion(later), moved.own, 100);
  REQUIRE(part.none == "");
  const double t = moved.history.events[0].t;
  std::size_t left_out = 0;
  for (std::size_t i = 0; i < part.t.size(); ++i)
    if (std::isnan(part.errors[i].back())) {
      ++left_out;
      CHECK(part.t[i] > t);
      CHECK(part.t[i] < t + 0.1);
    } else {
      CHECK(std::abs(part.errors[i].back()) < 0.2);
    }
  CHECK(left_out > 2);
  for (const double error : part.probes) CHECK(std::isfinite(error));
}

TEST_CASE("error budget: a part ends where an event happens in one model only") {
  const Switched moved(scene_of(bent, "probe: tip.y, crosses: 0.15", "8", "4e-3"));
  REQUIRE(moved.history.events.size() == 1);
  scene::Scene never = moved.scene;
  never.events[0].crosses = 30;
  const assess::ErrorPart part = assess::estimate_mesh_error(moved.motion(never), moved.own, 100);
  REQUIRE(part.none == "");
  CHECK(part.until == Approx(moved.history.events[0].t));
  REQUIRE(part.notes.size() == 2);
  CHECK_THAT(part.notes[1], Catch::Contains("later than t ="));  // the root, which moves when it is released
  CHECK_THAT(part.notes[0], Catch::Contains("from which on event off makes the joints of both models differ"));
}
