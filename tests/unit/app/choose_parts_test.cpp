#include <algorithm>

#include "../../../src/app/choose.h"
#include "../../../src/app/compare_table.h"
#include "../../../src/app/discretisation.h"
#include "../../../src/app/exact_motion.h"
#include "command_tests.h"

using namespace floe::app;

namespace {

/// A beam of L = EI = rhoA = 1 under a force F sin 2t at its end; other keys of the body and the scene.
std::string beam(const std::string& F, const std::string& body = "", const std::string& probe = "{at: beam.end}",
                 const std::string& joint = "fixed", const std::string& elements = "4") {
  return "bodies:\n  beam:\n    mesh: {line: {from: [0, 0], to: [1, 0], elements: " + elements +
         "}}\n    section: {EA: 1e5, EI: 1, rhoA: 1}\n    reduction: {modes: 3}\n" + body +
         "joints: {clamp: {type: " + joint +
         ", between: [ground, beam.start]}}\n"
         "loads: {tip: {type: force, at: beam.end, force: [0, \"" +
         F +
         "*sin(2*t)\"]}}\n"
         "motion: {end: 0.8, step: 0.02}\nprobes: {tip: " +
         probe + "}\n";
}

Series moved(const scene::Scene& scene, Formulation formulation) {
  RunPlan plan;
  plan.quiet = true, plan.check_range = false;
  return run(scene, formulation, PETSC_COMM_SELF, std::nullopt, plan).series;
}

/// The motion of what was chosen.
Series of_choice(Chosen& chosen) {
  RunPlan plan;
  plan.quiet = true, plan.check_range = false;
  return move(chosen.scene, chosen.model, 0, PETSC_COMM_WORLD, std::nullopt, plan).series;
}

Chosen choice_of(const std::string& text, double share, bool total) {
  return choose(scene::parse_scene(text, "scene.yaml"), {share, total}, PETSC_COMM_WORLD);
}

std::string reason_of(const Chosen& chosen, const std::string& what) {
  for (const Decision& one : chosen.decisions)
    if (one.what == what) return one.choice + ": " + one.reason;
  return "";
}

}  // namespace

TEST_CASE("accuracy: a beam that hardly bends beside its rotation becomes rigid; one that bends little, linear") {
  const std::string stiff = beam("1e-3", "", "{at: beam.end}", "revolute");
  Chosen rigid = choice_of(stiff, 0.15, false);
  CHECK_THAT(reason_of(rigid, "bodies"), Contains("rigid: error "));
  CHECK(rigid.selection.count() == 0);
  CHECK(rigid.within());
  CHECK(worst_error(of_choice(rigid), moved(scene::parse_scene(stiff, "s"), Formulation::nlffr)) < 0.15);

  const std::string little = beam("1e-3", "", "{at: beam.end, quantity: rotation}");
  Chosen linear = choice_of(little, 0.05, false);
  CHECK_THAT(reason_of(linear, "elastic force"), Contains("linear: linear: "));
  CHECK(linear.selection.linear);
  const Series first = of_choice(linear);
  CHECK(worst_error(first, moved(scene::parse_scene(little, "s"), Formulation::nlffr)) < 0.05);
  const nlohmann::ordered_json j = to_json(linear);
  CHECK(j["supported"].get<double>() <= 0.05);
  CHECK(decisions_table(linear).rows.size() == linear.decisions.size());
  // the same once more, from its start
  assembly::Model again = another_model(linear, PETSC_COMM_WORLD);
  RunPlan plan;
  plan.quiet = true, plan.check_range = false;
  CHECK(worst_error(move(linear.scene, again, 0, PETSC_COMM_WORLD, std::nullopt, plan).series, first) < 1e-9);
}

// Pieces of two by two shells have more candidates than nodes: derivatives are dropped that have drilling rotations of
// their own, without which the pieces lock.
TEST_CASE("accuracy: the richest model of coarse pieces of a plate moves as the full-order model") {
  const scene::Scene scene = scene::parse_scene(R"yaml(
gravity: [0, 1, -9.81]
bodies:
  plate:
    mesh: {plate: {along: [1, 0, 0], across: [0, 0.4, 0], elements: [8, 2]}}
    section: {thickness: 0.01}
    material: {E: 2e8, nu: 0.3, rho: 1000}
    frames: 4
    reduction: {modes: 5, interface_degree: 2}
joints: {root: {type: fixed, between: [ground, plate.left]}}
motion: {end: 0.3, step: 5e-3}
probes: {tip: {at: plate.right}, bend: {at: plate.right, quantity: rotation}}
)yaml",
                                                "scene.yaml");
  const assess::CandidateBasis candidates(scene, PETSC_COMM_SELF);
  assembly::Model richest = candidates.model(candidates.whole());
  RunPlan plan;
  plan.quiet = true, plan.check_range = false;
  const Series found = move(scene, richest, 0, PETSC_COMM_SELF, std::nullopt, plan).series;
  CHECK(worst_error(found, moved(scene, Formulation::nlffr)) < 0.01);
}

TEST_CASE("accuracy: what cannot be estimated is refused") {
  std::string text = beam("0.5");
  text = text.substr(0, text.find("probes:"));
  CHECK_THROWS_WITH(choice_of(text, 0.1, false), Contains("probes"));
  CHECK_THROWS_AS(choice_of(text, 0.1, true), InputError);
}

TEST_CASE("total accuracy: all parts of a deflection in a mean-axis frame are bounded") {
  const std::string text =
      beam("0.3", "    frame: mean-axis\n", "{at: beam.end, quantity: deflection}", "revolute", "3");
  Chosen chosen = choice_of(text, 0.03, true);
  CHECK(chosen.unbounded.empty());
  CHECK(chosen.within());
  scene::Scene fine = scene::parse_scene(text, "s");
  fine.bodies[0].mesh.elements = {24}, fine.motion.step /= 4, fine.motion.every = 4;
  CHECK(worst_error(of_choice(chosen), moved(fine, Formulation::cfr)) < 1.5 * 0.03);
}

TEST_CASE("total accuracy: of two bodies only the one that needs them gets more frames or elements") {
  const std::string text = R"yaml(
bodies:
  soft:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 4}}
    section: {EA: 1e5, EI: 1, rhoA: 1}
    reduction: {modes: 2}
  stiff:
    mesh: {line: {from: [1, 0], to: [1.5, 0], elements: 4}}
    section: {EA: 1e7, EI: 100, rhoA: 0.1}
    reduction: {modes: 2}
joints:
  clamp: {type: fixed, between: [ground, soft.start]}
  tip: {type: fixed, between: [soft.end, stiff.start]}
loads: {push: {type: force, at: soft.end, force: [0, "1.5*sin(2*t)"]}}
motion: {end: 0.8, step: 0.02}
probes: {tip: {at: soft.end}}
)yaml";
  Chosen chosen = choice_of(text, 0.03, true);
  CHECK(chosen.unbounded.empty());
  CHECK(chosen.within());
  CHECK(chosen.scene.bodies[1].frames == 1);
  CHECK_THAT(reason_of(chosen, "mesh and frames"), Contains("soft: ") && Contains("stiff: 4 elements in 1 frame"));
  scene::Scene fine = scene::parse_scene(text, "s");
  fine.bodies[0].mesh.elements = fine.bodies[1].mesh.elements = {16};
  fine.motion.step /= 2, fine.motion.every = 2;
  CHECK(worst_error(of_choice(chosen), moved(fine, Formulation::cfr)) < 0.036);
}

// The drive begins with a jump of the acceleration, so that axial waves of the stiff links, which no step resolves,
// make most of the torque: the estimated error of the reference is 15 %.
TEST_CASE("total accuracy: where the reference has a large error, the scene's own model is kept, and written") {
  const std::string text = R"yaml(
bodies:
  crank:
    mesh: {line: {from: [0, 0], to: [0, 0.2], elements: 1}}
    section: &square {shape: rectangle, width: 0.01, height: 0.01}
    material: &aluminium {E: 7e10, rho: 2700}
  coupler:
    mesh: {line: {from: [0, 0.2], to: [0.6, 0.45], elements: 1}}
    section: {shape: rectangle, width: 0.01, height: 0.005}
    material: *aluminium
  rocker:
    mesh: {line: {from: [0.6, 0.45], to: [0.6, 0], elements: 1}}
    section: *square
    material: *aluminium
joints:
  o: {type: driven, between: [ground, crank.start], angle: "30*t^2"}
  a: {type: revolute, between: [crank.end, coupler.start]}
  b: {type: revolute, between: [coupler.end, rocker.start]}
  c: {type: revolute, between: [rocker.end, ground]}
motion: {end: 0.5, step: 5e-3}
probes: {torque: {joint: o, quantity: moment}}
)yaml";
  Chosen chosen = choice_of(text, 0.01, true);
  CHECK_FALSE(chosen.within());
  CHECK(chosen.richest > 0.1);
  CHECK(summary_of(chosen) == "the scene's own model");
  CHECK_THAT(reason_of(chosen, "model"), Contains("begin smoothly"));
  const Series own = of_choice(chosen);
  CHECK(worst_error(own, moved(scene::parse_scene(text, "s"), Formulation::vm_md)) < 1e-9);
  scene::Scene fine = scene::parse_scene(text, "s");
  for (auto& body : fine.bodies) body.mesh.elements = {4};
  fine.motion.step /= 16, fine.motion.every = 16;
  const double error = worst_error(own, moved(fine, Formulation::cfr));
  CAPTURE(error, chosen.supported, chosen.richest);
  CHECK(chosen.supported > 0.7 * error);
  CHECK(chosen.supported < 3 * error);
  const OwnFolder folder;
  const std::string path = folder.path / "own.yaml";
  CHECK(write_scene(chosen, path, false, PETSC_COMM_WORLD) == std::vector{path});
  CHECK_THROWS_WITH(write_scene(chosen, path, false, PETSC_COMM_WORLD), Contains("exists"));
  CHECK(worst_error(moved(scene::read_scene(path), Formulation::vm_md), own) < 1e-9);
}

TEST_CASE("total accuracy: what the reference does not resolve is not required of models") {
  Chosen chosen = choice_of(beam("0.3"), 1e-9, true);
  CHECK(chosen.asked == 1e-9);
  CHECK_FALSE(chosen.within());
  CHECK_THAT(reason_of(chosen, "reference"), Contains("too large for the accuracy requested"));
  CHECK(chosen.richest < 1e-5);
  CHECK(chosen.supported < 1e-4);
}

TEST_CASE("accuracy: of a scene with adaptive steps fixed steps are selected, in its text, too") {
  std::string text = beam("0.3");
  text.replace(text.find("step: 0.02"), 10, "step: 0.02, tolerance: 1e-4");
  const Chosen chosen = choice_of(text, 0.05, true);
  CHECK(chosen.within());
  CHECK_FALSE(chosen.scene.motion.tolerance);
}

TEST_CASE("total accuracy: a mesh from a file is refined, in the text of the scene, too") {
  const OwnFolder own;
  own.write("line.inp",
            "*NODE\n1, 0, 0, 0\n2, 0.25, 0, 0\n3, 0.5, 0, 0\n4, 0.75, 0, 0\n5, 1, 0, 0\n*ELEMENT, TYPE=B31, ELSET=all\n"
            "1, 1, 2\n2, 2, 3\n3, 3, 4\n4, 4, 5\n*NSET, NSET=root\n1,\n*NSET, NSET=tip\n5,\n");
  const std::string file = own.write("scene.yaml",
                                     "bodies:\n  body:\n    mesh: {file: {path: line.inp}}\n"
                                     "    section: {A: 1e-3, Iy: 1e-8, Iz: 1e-8, J: 2e-8, orientation: [0, 1, 0]}\n"
                                     "    material: {E: 7e10, G: 2.6e10, rho: 2700}\n    reduction: {modes: 2}\n"
                                     "joints: {clamp: {type: fixed, between: [ground, body.root]}}\n"
                                     "loads: {push: {type: force, at: body.tip, force: [0, 0, \"100*sin(20*t)\"]}}\n"
                                     "motion: {end: 0.08, step: 2e-3}\nprobes: {tip: {at: body.tip}}\n");
  Chosen chosen = choose(scene::read_scene(file), {0.05, true}, PETSC_COMM_WORLD);
  CHECK(chosen.unbounded.empty());
  CHECK(chosen.within());
  CHECK_THAT(reason_of(chosen, "reference"), Contains("cfr, elements 1/"));
  scene::Scene fine = scene::read_scene(file);
  fine.bodies[0].mesh.file->refine = 2;
  fine.motion.step /= 4, fine.motion.every = 4;
  CHECK(worst_error(of_choice(chosen), moved(fine, Formulation::cfr)) < 0.06);
}

TEST_CASE("discretised scenes have other elements, frames and strains in their text, of every kind of mesh") {
  const auto text_of = [](const std::string& mesh, const std::string& more) {
    return "bodies:\n  b:\n    mesh: {" + mesh + "}\n" + more + "    reduction: {modes: 3, derivatives: [[1, 1]]}\n";
  };
  const std::string tube =
      "    section: {shape: tube, radius: 0.02, wall: 0.005, orientation: [0, 0, 1]}\n"
      "    material: {E: 7e10, nu: 0.3, rho: 2700}\n";
  const auto changed = [](const std::string& text, const Discretised& to) {
    const scene::Scene scene = scene::parse_scene(text, "scene.yaml");
    return discretised(scene, {to}).bodies.at(0);
  };
  const std::string line = text_of("line: {from: [0, 0, 0], to: [1, 0, 0], elements: 3}", tube);
  CHECK(changed(line, {1, 4, {}}).mesh.elements == std::vector{12});
  CHECK(changed(line, {1, 1, fem::Strains::second_order}).strains == fem::Strains::second_order);
  CHECK(changed(line, {1, 1, fem::Strains::von_karman}).strains == fem::Strains::von_karman);
  const std::string plate = text_of("plate: {along: [1, 0, 0], across: [0, 1, 0], elements: [3, 2]}",
                                    "    section: {thickness: 0.01}\n    material: {E: 7e10, nu: 0.3, rho: 2700}\n");
  CHECK(changed(plate, {1, 2, {}}).mesh.plate->elements == std::array{6, 4});
  const std::string file =
      text_of("file: {path: wing.msh, refine: 1}", "    material: {E: 7e10, nu: 0.3, rho: 2700}\n");
  CHECK(changed(file, {1, 4, {}}).mesh.file->refine == 3);
  CHECK_FALSE(divisible(scene::parse_scene(file, "s").bodies[0]));
  const std::string bent = text_of("polyline: {points: [[0, 0, 0], [1, 0, 0], [1, 1, 0]], elements: [2, 3]}", tube);
  CHECK(changed(bent, {1, 2, {}}).mesh.elements == std::vector{4, 6});
  CHECK_FALSE(divisible(scene::parse_scene(bent, "s").bodies[0]));
  const scene::Body halves = changed(line, {2, 2, {}});
  CHECK(halves.frames == 2);
  CHECK(halves.reduction.modes.count == 3);  // two in each and one more, of three
}

TEST_CASE("differences of motions are added at the instants that all have") {
  Series y{{0, 1, 2}, {{1}, {2}, {3}}, {}, {}}, a{{0, 1}, {{10}, {20}}, {}, {}}, b{{0, 1, 2}, {{1}, {1}, {1}}, {}, {}};
  add_difference(y, 0.5, a, b);
  CHECK(y.t == std::vector<double>{0, 1});
  CHECK(y.values == std::vector<std::vector<double>>{{5.5}, {11.5}});
}
