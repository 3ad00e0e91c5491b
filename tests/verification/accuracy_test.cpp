#include <catch2/catch.hpp>

#include "../../src/app/choose.h"
#include "../../src/app/compare_table.h"
#include "../unit/output/scratch.h"
#include "scene_motion.h"

using namespace floe;
using namespace floe::test;

namespace {

const std::string pendulum = R"yaml(
gravity: [0, -9.81]
bodies:
  rod:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 16}}
    section: {EA: 1.2e4, EI: 0.5, rhoA: 1}
    reduction: {modes: 4}
joints: {hinge: {type: revolute, between: [ground, rod.start]}}
motion: {end: 0.6, step: 1e-3, every: 2}
probes: {tip: {at: rod.end, quantity: position}, middle: {at: rod.middle, quantity: deflection}}
)yaml";

const std::string plate = R"yaml(
bodies:
  plate:
    mesh: {plate: {along: [1, 0, 0], across: [0, 0.5, 0], elements: [8, 4]}}
    section: {thickness: 0.01}
    material: {E: 7e10, nu: 0.3, rho: 2700}
joints: {root: {type: fixed, between: [ground, plate.left]}}
loads: {corner: {type: force, at: plate.p3, force: [0, 0, "300*sin(40*t)"]}}
motion: {end: 0.15, step: 1e-3}
probes: {tip: {at: plate.p3}}
)yaml";

app::RunPlan quiet() {
  app::RunPlan plan;
  plan.quiet = true, plan.check_range = false;
  return plan;
}

/// Full order in steps of a quarter.
app::Series reference_motion(scene::Scene scene) {
  scene.motion.step /= 4, scene.motion.every *= 4;
  return app::run(scene, Formulation::nlffr, PETSC_COMM_WORLD, std::nullopt, quiet()).series;
}

}  // namespace

TEST_CASE("accuracy: the selected model satisfies the required error, and reports it") {
  for (const std::string& text : {pendulum, plate}) {
    const scene::Scene scene = scene::parse_scene(text, "scene");
    const app::Series full = reference_motion(scene);
    std::size_t columns = 0;
    double motion = 0;
    for (const double accuracy : {0.05, 0.01, 0.002}) {
      app::Chosen chosen = app::choose(scene, {accuracy, false}, PETSC_COMM_WORLD);
      const app::RunResult result = app::move(chosen.scene, chosen.model, 0, PETSC_COMM_WORLD, std::nullopt, quiet());
      const double error = app::worst_error(result.series, full);
      INFO(scene.bodies[0].name << ", asked " << accuracy << ", supported " << chosen.supported << ", true " << error
                                << ", " << chosen.selection.count() << " columns, step " << chosen.scene.motion.step);
      CHECK(chosen.within());
      CHECK(error <= accuracy);
      CHECK(chosen.supported > 0.5 * error);
      CHECK(chosen.supported < 3 * error);
      CHECK(chosen.selection.count() >= columns);  // more for less error
      CHECK((motion == 0 || chosen.scene.motion.step <= motion));
      columns = chosen.selection.count(), motion = chosen.scene.motion.step;
      CHECK_FALSE(chosen.decisions.empty());
    }
    CHECK(columns > 0);
  }
}

// Two halvings of the step and more: the reference solution is extrapolated from the last two.
TEST_CASE("accuracy: the reference solution is accurate where the scene's step is too long") {
  scene::Scene scene = scene::parse_scene(pendulum, "scene");
  scene.motion.step = 1.5e-2, scene.motion.every = 1;
  scene::Scene fine = scene;
  fine.motion.step /= 16, fine.motion.every *= 16;
  const app::Series full = reference_motion(fine);
  for (const double accuracy : {0.01, 0.001}) {
    app::Chosen chosen = app::choose(scene, {accuracy, false}, PETSC_COMM_WORLD);
    const app::RunResult result = app::move(chosen.scene, chosen.model, 0, PETSC_COMM_WORLD, std::nullopt, quiet());
    const double error = app::worst_error(result.series, full);
    INFO("asked " << accuracy << ", supported " << chosen.supported << ", richest " << chosen.richest << ", true "
                  << error << ", step " << chosen.scene.motion.step);
    CHECK(chosen.within());
    CHECK(chosen.scene.motion.step < scene.motion.step);
    CHECK(error <= accuracy);
    CHECK(chosen.supported > 0.5 * error);
    CHECK(chosen.supported < 3 * error);
  }
}

TEST_CASE("accuracy: a probe that is zero by symmetry has no effect") {
  const auto chosen = [](const std::string& probes) {
    return app::choose(scene::parse_scene(R"yaml(
gravity: [0, -9.81]
bodies:
  rod:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 20}}
    section: {EA: 1.2e5, EI: 10, rhoA: 1}
    frame: pinned
    reduction: {modes: 3, derivatives: all}
joints: {a: {type: revolute, between: [ground, rod.start]}, b: {type: revolute, between: [ground, rod.end]}}
motion: {end: 0.1, step: 1e-3}
probes: {middle: {at: rod.middle, quantity: deflection})yaml" +
                                              probes + "}\n",
                                          "scene"),
                       {0.01, false}, PETSC_COMM_WORLD);
  };
  const app::Chosen one = chosen(""), two = chosen(", turn: {at: rod.middle, quantity: rotation}");
  CHECK(two.selection.count() == one.selection.count());
  CHECK(two.scene.motion.step == one.scene.motion.step);
  CHECK(two.supported == Approx(one.supported).epsilon(0.01));
}

TEST_CASE("accuracy: the scene that is written reproduces the selected model") {
  for (const auto& [text, accuracy] : {std::pair{pendulum, 0.01}, std::pair{plate, 0.05}}) {
    const scene::Scene scene = scene::parse_scene(text, "scene");
    app::Chosen chosen = app::choose(scene, {accuracy, false}, PETSC_COMM_WORLD);
    REQUIRE_FALSE(chosen.candidates->has_responses(chosen.selection));
    const app::RunResult result = app::move(chosen.scene, chosen.model, 0, PETSC_COMM_WORLD, std::nullopt, quiet());
    const scene::Scene written = scene::parse_scene(chosen.scene.text, "written");
    CHECK(written.motion.step == chosen.scene.motion.step);
    const app::RunResult again = app::run(written, Formulation::vm_md, PETSC_COMM_WORLD, std::nullopt, quiet());
    CHECK(again.coordinates == result.coordinates);
    CHECK(again.series.t.size() == result.series.t.size());
    CHECK(again.series.t[1] == Approx(scene.motion.step * scene.motion.every));  // stored as the scene wants it
    CHECK(app::worst_error(again.series, result.series) < 1e-8);
  }
}

TEST_CASE("accuracy: correction vectors are written as residual responses of the scene") {
  const scene::Scene scene = scene::parse_scene(plate, "scene");
  app::Chosen chosen = app::choose(scene, {0.002, false}, PETSC_COMM_WORLD);
  REQUIRE(chosen.selection.responses >= 1);
  REQUIRE_FALSE(chosen.candidates->has_responses(chosen.selection));
  const app::RunResult result = app::move(chosen.scene, chosen.model, 0, PETSC_COMM_WORLD, std::nullopt, quiet());
  const double error = app::worst_error(result.series, reference_motion(scene));
  INFO("supported " << chosen.supported << ", true " << error);
  CHECK(chosen.within());
  CHECK(error <= 0.002);
  const Scratch folder;
  const std::string path = (folder / "chosen.yaml").string();
  const std::vector<std::string> files = chosen.candidates->write(chosen.selection, chosen.scene.motion, path, false);
  CHECK(files == std::vector{path});
  const scene::Scene written = scene::read_scene(path);
  CHECK(written.bodies[0].reduction.responses > 0);
  const app::RunResult again = app::run(written, Formulation::vm_md, PETSC_COMM_WORLD, std::nullopt, quiet());
  CHECK(again.coordinates == result.coordinates);
  CHECK(app::worst_error(again.series, result.series) < 1e-8);
}

TEST_CASE("accuracy: correction vectors themselves are written to the file of a reduced body") {
  const scene::Scene scene = scene::parse_scene(plate, "scene");
  app::Chosen chosen = app::choose(scene, {0.002, false}, PETSC_COMM_WORLD);
  assess::Selection selection = chosen.selection;
  selection.responses = 0;
  REQUIRE(chosen.candidates->has_responses(selection));
  assembly::Model model = chosen.candidates->model(selection);
  const app::RunResult result = app::move(chosen.scene, model, 0, PETSC_COMM_WORLD, std::nullopt, quiet());
  const Scratch folder;
  const std::string path = (folder / "chosen.yaml").string();
  const std::vector<std::string> files = chosen.candidates->write(selection, chosen.scene.motion, path, false);
  REQUIRE(files.size() == 2);
  CHECK(files[1] == (folder / "chosen-plate.h5").string());
  CHECK_THROWS_WITH(chosen.candidates->write(selection, chosen.scene.motion, path, false), Catch::Contains("exists"));
  const app::RunResult again =
      app::run(scene::read_scene(path), Formulation::vm_md, PETSC_COMM_WORLD, std::nullopt, quiet());
  CHECK(again.coordinates == result.coordinates);
  CHECK(app::worst_error(again.series, result.series) < 1e-8);
}

TEST_CASE("accuracy: small bending selects a linear elastic force, no bending a rigid body") {
  const std::string arm = R"yaml(
bodies:
  arm:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 10}}
    section: {EA: 1e6, EI: $EI, rhoA: 1}
joints: {hinge: {type: revolute, between: [ground, arm.start]}}
loads: {drive: {type: moment, at: arm.start, moment: "0.1*sin(8*t)"}}
motion: {end: 0.5, step: 1e-3}
probes: {tip: {at: arm.end}}
)yaml";
  const auto chosen = [&](const std::string& stiffness) {
    return app::choose(scene::parse_scene(fill(arm, {{"EI", stiffness}}), "scene"), {0.01, false}, PETSC_COMM_WORLD);
  };
  CHECK(chosen("1e5").selection.count() == 0);
  const app::Chosen soft = chosen("1");
  CHECK(soft.selection.count() > 0);
}

TEST_CASE("accuracy: bodies of two frames, and one enriched by residual responses") {
  const std::string text = R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 12}}
    section: {EA: 1.2e4, EI: 1, rhoA: 1}
    frames: $frames
    reduction: {modes: $modes}
joints: {clamp: {type: fixed, between: [ground, beam.start]}}
loads: {tip: {type: force, at: {body: beam, node: [0.5, 0]}, force: [0, "2*sin(9*t)"]}}
motion: {end: 0.4, step: 1e-3}
probes: {tip: {at: beam.end}}
)yaml";
  for (const Words& words : {Words{{"frames", "2"}, {"modes", "4"}}, Words{{"frames", "1"}, {"modes", "1"}}}) {
    const scene::Scene scene = scene::parse_scene(fill(text, words), "scene");
    app::Chosen chosen = app::choose(scene, {0.002, false}, PETSC_COMM_WORLD);
    const app::RunResult result = app::move(chosen.scene, chosen.model, 0, PETSC_COMM_WORLD, std::nullopt, quiet());
    const double error = app::worst_error(result.series, reference_motion(scene));
    INFO(words[0].second << " frames: supported " << chosen.supported << ", true " << error);
    CHECK(chosen.within());
    CHECK(error <= 0.002);
  }
}

// The pieces of a body have vectors of their own, in one list of the written scene.
TEST_CASE("accuracy: scenes of bodies in several frames reproduce the selected models") {
  const std::string arm = R"yaml(
bodies:
  arm:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 12}}
    frames: 3
    section: {A: 1.2e-4, I: 3.6e-10}
    material: {E: 7e10, rho: 2700}
    reduction: {modes: 4}
joints: {shoulder: {type: driven, between: [ground, arm.start], angle: "pi/4*(1 - cos(2*pi*t))"}}
motion: {end: 0.4, step: 1e-3}
probes: {tip: {at: arm.end, quantity: position}, bend: {at: arm.end, relative_to: arm.start}}
)yaml",
                    rod = R"yaml(
gravity: [0, 0, -9.81]
bodies:
  rod:
    mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: 9}}
    frames: 3
    section: {shape: rectangle, width: 0.02, height: 0.005, orientation: [0, 1, 0]}
    material: {E: 7e8, nu: 0.3, rho: 2700}
    reduction: {modes: 4}
joints: {h: {type: revolute, between: [ground, rod.start], axis: [0, 1, 0]}}
motion: {end: 0.2, step: 1e-3}
probes: {tip: {at: rod.end}}
)yaml";
  for (const auto& [text, accuracy] : {std::pair{arm, 0.01}, std::pair{rod, 0.02}}) {
    app::Chosen chosen = app::choose(scene::parse_scene(text, "scene"), {accuracy, false}, PETSC_COMM_WORLD);
    REQUIRE_FALSE(chosen.candidates->has_responses(chosen.selection));
    const app::RunResult result = app::move(chosen.scene, chosen.model, 0, PETSC_COMM_WORLD, std::nullopt, quiet());
    const scene::Scene written = scene::parse_scene(chosen.scene.text, "written");
    const app::RunResult again = app::run(written, Formulation::vm_md, PETSC_COMM_WORLD, std::nullopt, quiet());
    CHECK(again.coordinates == result.coordinates);
    CHECK(app::worst_error(again.series, result.series) < 1e-8);
  }
  std::string few = arm;
  few.replace(few.find("modes: 4"), 8,
              "attachment: all, columns: [mode 1, attachment arm#1-2.moment, attachment arm.fx]");
  CHECK_THROWS_WITH(
      app::run(scene::parse_scene(few, "scene"), Formulation::vm_md, PETSC_COMM_WORLD, std::nullopt, quiet()),
      Catch::Contains("body arm has no basis vector \"attachment arm.fx\"") && !Catch::Contains("#3"));
  few.replace(few.find("mode 1, "), 8, "");  // the third piece has none of them
  few.replace(few.find(", attachment arm.fx"), 19, "");
  const app::RunResult stiff =
      app::run(scene::parse_scene(few, "scene"), Formulation::vm_md, PETSC_COMM_WORLD, std::nullopt, quiet());
  CHECK(stiff.series.t.size() == 401);
  const auto named = [&](const std::string& columns) {
    std::string own = arm;
    own.replace(own.find("modes: 4"), 8, "attachment: all, columns: [" + columns + "]");
    return app::run(scene::parse_scene(own, "scene"), Formulation::vm_md, PETSC_COMM_WORLD, std::nullopt, quiet());
  };
  const int three = named("mode 1").coordinates;
  CHECK(named("mode 1, \"#2 mode 2\"").coordinates == three + 1);
  CHECK(named("\"#1 mode 1\", \"#2 mode 1\", \"#3 mode 1\"").coordinates == three);
  CHECK_THROWS_WITH(named("mode 1, \"#4 mode 1\""), Catch::Contains("body arm has no basis vector \"#4 mode 1\""));
}

// Two frames, as a bent panel of this width needs, and the vectors that its motion needs of each piece.
TEST_CASE("accuracy: a panel half as wide as long, bent by a third of its length, within 2 % on 40 coordinates") {
  const scene::Scene scene = scene::parse_scene(R"yaml(
bodies:
  panel:
    mesh: {plate: {along: [1, 0, 0], across: [0, 0.5, 0], elements: [16, 8]}}
    section: {thickness: 4e-3}
    material: {E: 7e9, nu: 0.3, rho: 1500}
    frames: 2
    reduction: {modes: 4, interface_degree: 0}
joints: {root: {type: fixed, between: [ground, panel.left]}}
loads: {p: {type: force, at: panel.right, force: [0, 0, "10*(1 - cos(pi*t))"]}}
motion: {end: 1, step: 4e-3}
probes: {tip: {at: panel.right}, corner: {at: panel.p3}}
)yaml",
                                                "scene");
  app::Chosen chosen = app::choose(scene, {0.02, false}, PETSC_COMM_WORLD);
  const app::RunResult result = app::move(chosen.scene, chosen.model, 0, PETSC_COMM_WORLD, std::nullopt, quiet());
  scene::Scene full = chosen.scene;  // in its steps
  const app::RunResult exact = app::run(full, Formulation::nlffr, PETSC_COMM_WORLD, std::nullopt, quiet());
  const double error = app::worst_error(result.series, exact.series);
  INFO(result.coordinates << " coordinates, error " << error);
  CHECK(result.coordinates <= 40);
  CHECK(error <= 0.02);
  CHECK(*std::max_element(exact.series.values.back().begin(), exact.series.values.back().end()) > 0.25);
}

// A shape that stretches the body, so that its pieces end where few columns go.
TEST_CASE("accuracy: a body of two frames that is stretched at the start") {
  const std::string stretched = R"yaml(
bodies:
  rod:
    mesh: {line: {from: $from, to: $to, elements: 8}}
    frames: 2
    section: $section
    material: {E: 7e6$nu, rho: 2700}
    reduction: {modes: 4}
    initial: {deformation: $shape}
joints: {h: {type: revolute, between: [ground, rod.start]$axis}}
motion: {end: 0.04, step: 1e-3}
probes: {tip: {at: rod.end}}
)yaml";
  const Words plane{
      {"from", "[0, 0]"}, {"to", "[1, 0]"}, {"section", "{A: 1e-4, I: 2e-10}"}, {"shape", "[0, \"0.05*x^2\"]"},
      {"axis", ""},       {"nu", ""}},
      space{{"from", "[0, 0, 0]"},
            {"to", "[1, 0, 0]"},
            {"section", "{shape: rectangle, width: 0.02, height: 0.005, orientation: [0, 1, 0]}"},
            {"shape", "[0, 0, \"0.05*x^2\"]"},
            {"axis", ", axis: [0, 1, 0]"},
            {"nu", ", nu: 0.3"}};
  for (const Words& words : {plane, space}) {
    const scene::Scene scene = scene::parse_scene(fill(stretched, words), "scene");
    app::Chosen chosen = app::choose(scene, {0.02, false}, PETSC_COMM_WORLD);
    const app::RunResult result = app::move(chosen.scene, chosen.model, 0, PETSC_COMM_WORLD, std::nullopt, quiet());
    CHECK(chosen.within());
    CHECK(app::worst_error(result.series, reference_motion(scene)) <= 0.02);
  }
}

TEST_CASE("accuracy: refuses scenes without an estimate") {
  const auto refused = [](const std::string& text, const std::string& phrase) {
    CHECK_THROWS_WITH(app::choose(scene::parse_scene(text, "scene"), {0.01, false}, PETSC_COMM_WORLD),
                      Catch::Contains(phrase));
  };
  refused(pendulum.substr(0, pendulum.find("probes")), "there are none");
  refused(pendulum + "events: {off: {unlock: hinge, at: 0.1}}\n", "events change the joints");
}

TEST_CASE("accuracy: errors of the full-order model itself are warned of") {
  const scene::Scene scene = scene::parse_scene(R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 10}}
    section: {EA: 1e4, EI: 1, rhoA: 1e-2}
    frame: {type: clamped, at: start}
joints: {clamp: {type: fixed, between: [ground, beam.start]}}
loads: {tip: {type: force, at: beam.end, force: [0, "1.5*(1 - cos(pi*t))"]}}
motion: {end: 1, step: 1e-2}
probes: {tip: {at: beam.end}}
)yaml",
                                                "scene");
  app::Chosen chosen = app::choose(scene, {0.01, false}, PETSC_COMM_WORLD);
  CHECK(chosen.within());
  app::RunPlan plan;
  plan.quiet = true, plan.measured = true;
  const auto moved = app::move(chosen.scene, chosen.model, 0, PETSC_COMM_WORLD, std::nullopt, plan);
  REQUIRE(moved.out_of_range.size() == 1);
  CHECK(moved.out_of_range[0].what == "slope");
  CHECK(moved.out_of_range[0].value == Approx(0.53).epsilon(0.4));  // 1 for .603 of the length (elastica)
  CHECK(std::count(moved.warnings.begin(), moved.warnings.end(), moved.out_of_range[0].text) == 1);
}

// A shaft whose bearings leave a small basis redundant constraints, and one whose bodies have no derivatives to add to
// those that rank the vectors: both were refused.
TEST_CASE("accuracy: shafts in bearings") {
  const std::string text = R"yaml(
bodies:
  s:
    mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: 4}}
    section: {shape: circle, radius: 0.01, orientation: [0, 1, 0]}
    material: {E: 2.1e11, nu: 0.3, rho: 7850}
    $disk
joints:
  a: {type: driven, between: [ground, s.start], axis: [1, 0, 0], angle: "60*t^2"}
  b: {type: cylindrical, between: [ground, s.end], axis: [1, 0, 0]}
loads: {f: {type: force, at: s.middle, force: [0, 0, "50*sin(30*t)"]}}
motion: {end: 0.1, step: 1e-3}
probes: {d: {at: s.middle}}
)yaml";
  for (const std::string disk :
       {"masses: {d: {at: [0.25, 0, 0], mass: 4}}", "reduction: {modes: 4, derivatives: none}"}) {
    INFO(disk);
    const app::Chosen chosen =
        app::choose(scene::parse_scene(fill(text, {{"disk", disk}}), "scene"), {0.05, true}, PETSC_COMM_WORLD);
    CHECK(chosen.supported < 0.05);
  }
}
