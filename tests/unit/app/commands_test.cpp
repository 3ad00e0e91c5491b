#include "../../../src/app/commands.h"

#include <cmath>

#include "../../../src/app/equilibrium.h"
#include "../../../src/app/restart.h"
#include "command_tests.h"

namespace {

/// A rigid rod of 4 kg and 2 m, thrown.
const std::string thrown = R"yaml(
title: A thrown rod
bodies:
  rod:
    rigid: true
    frame: mean-axis
    mesh: {line: {from: [-1, 0], to: [1, 0], elements: 1}}
    section: {rhoA: 2}
    initial: {position: [1, 2], velocity: [3, 4], angular_velocity: 5}
gravity: [0, -10]
motion: {end: 0.4, step: 0.01}
probes:
  middle: {at: {body: rod, node: [0, 0]}, quantity: position}
  turned: {at: rod.end, quantity: rotation}
)yaml";

/// EI = 10, rhoA = 3, L = 2.
std::string beam(const std::string& rest) {
  return "bodies:\n  beam:\n    mesh: {line: {from: [0, 0], to: [2, 0], elements: 8}}\n"
         "    section: {EA: 1e5, EI: 10, rhoA: 3}\n    reduction: {modes: {count: 3, of: frame}}\n" +
         rest;
}

scene::Scene parsed(const std::string& text) { return scene::parse_scene(text, "scene.yaml"); }

double number(const std::string& word) { return std::stod(word); }

/// The complaint of work that a user's input stops.
template <class Work>
std::string refusal(const Work& work) {
  try {
    printed(work);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("run: a thrown rod, on its parabola, in the table, the summary and on the terminal") {
  const OwnFolder own;
  const auto folder = own.results("out");
  const std::string said = printed([&] { app::run_one(parsed(thrown), Formulation::vm_md, PETSC_COMM_WORLD, folder); });
  const auto columns = columns_of(folder.probes());
  REQUIRE(columns.size() == 4);
  REQUIRE(columns.at("t [s]").size() == 41);
  for (std::size_t i = 0; i < 41; ++i) {
    const double t = 0.01 * static_cast<double>(i);
    CHECK(number(columns.at("t [s]")[i]) == Approx(t).margin(1e-14));
    CHECK(number(columns.at("middle.x [m]")[i]) == Approx(1 + 3 * t).epsilon(1e-9));
    CHECK(number(columns.at("middle.y [m]")[i]) == Approx(2 + 4 * t - 5 * t * t).epsilon(1e-9));
    CHECK(number(columns.at("turned.angle [rad]")[i]) == Approx(5 * t).margin(1e-9));
  }
  const auto summary = nlohmann::json::parse(contents(folder.summary()));
  CHECK(summary["status"] == "finished");
  // kinetic energy 4 (3^2 + 4^2)/2 + (4 2^2/12) 5^2/2, of place -4 (-10) 2
  CHECK(summary["energy"]["end"].get<double>() == Approx(50 + 4 * 4 / 12. * 12.5 + 80).epsilon(1e-9));
  CHECK_THAT(said, Contains("A thrown rod") && Contains("40 steps") && Contains("2.8"));  // y = 2 + 1.6 - 0.8
  CHECK(std::filesystem::exists(folder.result()));
}

TEST_CASE("run: the summary has the frequencies of the basis, and why candidate vectors were dropped") {
  const OwnFolder own;
  const auto folder = own.results("out");
  const std::string text = beam(
      "joints:\n  root: {type: revolute, between: [ground, beam.start]}\nloads:\n"
      "  pull: {type: force, at: beam.end, force: [t, 0]}\n  push: {type: force, at: beam.end, force: [-t^2, 0]}\n"
      "motion: {end: 0.02, step: 0.01}\nprobes:\n  tip: {at: beam.end, quantity: displacement}\n");
  scene::Scene scene = parsed(text);
  scene.bodies[0].reduction.attachment = scene::ReductionSpec::Attachment::all;
  printed([&] { app::run_one(scene, Formulation::vm_md, PETSC_COMM_WORLD, folder); });
  const auto body = nlohmann::json::parse(contents(folder.summary()))["bodies"][0];
  REQUIRE(body["frequencies"].size() == 3);
  for (int n = 1; n <= 3; ++n)
    CHECK(body["frequencies"][n - 1]["rad_per_s"].get<double>() ==
          Approx(std::pow(n * M_PI / 2, 2) * std::sqrt(10 / 3.)).epsilon(2e-5 * std::pow(n, 4)));
  const auto dropped = [&](const std::string& name) {
    for (const auto& candidate : body["basis"])
      if (candidate["column"] == name) return candidate.value("dropped", std::string());
    return std::string("no such vector");
  };
  CHECK(dropped("attachment pull.fx") == "");
  CHECK(dropped("attachment push.fx") == "repeats pull.fx");
  CHECK(dropped("attachment root.fx") == "does not deform the body");
}

TEST_CASE("check: mass properties of each body, and frequencies on request") {
  const std::string said = printed([&] { app::check(parsed(thrown), PETSC_COMM_WORLD); });
  CHECK_THAT(said, Contains("centre x") && Contains("1.333333") && !Contains("[Hz]"));  // 4 kg (2 m)^2 / 12
  const std::string constrained =
      "joints:\n  root: {type: fixed, between: [ground, beam.start]}\n  tip: {type: revolute, between: [ground, "
      "beam.end]}\n";
  const std::string both = printed([&] { app::check(parsed(beam(constrained)), PETSC_COMM_WORLD, {}, 2); });
  CHECK_THAT(both, Contains("free") && Contains("as held") && Contains("1.62"));  // 22.373 sqrt(EI/rhoA)/L^2 / 2 pi
}

TEST_CASE("run: taken up from a checkpoint, the same motion; with another scene refused") {
  const OwnFolder own;
  const std::string text = beam(
      "gravity: [0, -1]\njoints:\n  root: {type: revolute, between: [ground, beam.start]}\nmotion: {end: 0.2, step: "
      "0.01}\nprobes:\n  tip: {at: beam.end, quantity: displacement}\n");
  const std::string file = own.write("scene.yaml", text);
  const scene::Scene scene = scene::read_scene(file);
  app::RunPlan plan;
  plan.checkpoints = app::checkpoint_every("5");
  const auto whole = own.results("whole"), parts = own.results("parts");
  printed([&] { app::run_one(scene, Formulation::vm_md, PETSC_COMM_WORLD, whole, plan); });
  plan.until = 0.1;
  printed([&] { app::run_one(scene, Formulation::vm_md, PETSC_COMM_WORLD, parts, plan); });
  CHECK(columns_of(parts.probes()).at("t [s]").size() == 11);
  CHECK_THAT(refusal([&] { app::restart_one(parts.path, "", {}, 0.05, {}, PETSC_COMM_WORLD); }),
             Contains("--until 0.05") && Contains("0.1"));
  CHECK_THAT(refusal([&] { app::restart_one(parts.path, "", "vm", {}, {}, PETSC_COMM_WORLD); }), Contains("vm+md"));
  own.write("scene.yaml", text + "title: another\n");
  CHECK_THAT(refusal([&] { app::restart_one(parts.path, "", {}, {}, {}, PETSC_COMM_WORLD); }),
             Contains("scene.yaml has changed"));
  own.write("scene.yaml", text);
  printed([&] { app::restart_one(parts.path, "", {}, {}, {}, PETSC_COMM_WORLD); });
  const auto once = columns_of(whole.probes()), twice = columns_of(parts.probes());
  REQUIRE(twice.at("tip.y [m]").size() == 21);
  for (std::size_t i = 0; i < 21; ++i)  // the first part's last step ends at 0.1, not at ten sums of 0.01
    CHECK(number(twice.at("tip.y [m]")[i]) == Approx(number(once.at("tip.y [m]")[i])).epsilon(1e-12).margin(1e-18));
  CHECK_THAT(refusal([&] { app::restart_one(own.path, "", {}, {}, {}, PETSC_COMM_WORLD); }), Contains("checkpoint"));
}

TEST_CASE("checkpoints each so many steps or seconds; other words are refused") {
  CHECK(app::checkpoint_every("1000").steps == 1000);
  CHECK(app::checkpoint_every("1000").seconds == 0);
  CHECK(app::checkpoint_every("1.5s").seconds == 1.5);
  CHECK(app::checkpoint_every("1.5s").steps == 0);
  CHECK((app::checkpoint_every("1").any() && app::checkpoint_every("1s").any() && !app::CheckpointEvery{}.any()));
  for (const char* word : {"", "s", "0", "-3", "1.5", "3e9", "inf", "nan", "10m", "0s", "5s5", "1e400"}) {
    INFO(word);
    CHECK_THROWS_AS(app::checkpoint_every(word), InputError);
  }
}

TEST_CASE("static: a cantilever under a load that grows, P L^3 / 3 EI at each step") {
  const auto formulation = GENERATE(Formulation::nlffr, Formulation::lffr, Formulation::vm_md, Formulation::cfr);
  const OwnFolder own;
  const auto folder = own.results("out");
  const std::string text = beam(
      "    frame: clamped\njoints:\n  root: {type: fixed, between: [ground, beam.start]}\nloads:\n  tip: {type: force, "
      "at: "
      "beam.end, force: [0, 3e-4*t]}\nprobes:\n  tip: {at: beam.end, quantity: displacement}\n");
  const std::string said = printed([&] {
    app::solve_static(parsed(text), formulation, PETSC_COMM_WORLD, {2, 4}, folder, true);
  });
  const auto columns = columns_of(folder.probes());
  REQUIRE(columns.at("tip.y [m]").size() == 5);
  // reduced: the static response of the tip's load is not among three modes of the frame: 97 + 2.5 + 0.3 %
  const bool reduced = formulation == Formulation::vm_md;
  for (int i = 0; i < 5; ++i) {
    const double exact = 3e-4 * 0.5 * i * 8 / 30;
    CHECK(number(columns.at("t [s]")[i]) == Approx(0.5 * i));
    CHECK(number(columns.at("tip.y [m]")[i]) == Approx(exact).epsilon(reduced ? 2e-3 : 1e-6).margin(1e-12));
  }
  const auto summary = nlohmann::json::parse(contents(folder.summary()));
  CHECK(summary["status"] == "finished");
  CHECK(summary["stability"] == "looked at");
  CHECK(summary.contains("estimate") == reduced);
  CHECK_THAT(said, Contains("4 equilibria to t = 2"));
}

TEST_CASE("static: a column beyond Euler's load is said to be unstable, and from which load on") {
  const OwnFolder own;
  const auto folder = own.results("out");
  // clamped and free: pi^2 EI / 4 L^2 = 6.17 N
  const std::string text = beam(
      "    frame: clamped\njoints:\n  root: {type: fixed, between: [ground, beam.start]}\nloads:\n  tip: {type: force, "
      "at: "
      "beam.end, force: [-t, 0]}\nprobes:\n  tip: {at: beam.end, quantity: displacement}\n");
  printed([&] { app::solve_static(parsed(text), Formulation::nlffr, PETSC_COMM_WORLD, {8, 80}, folder, false); });
  const auto summary = nlohmann::json::parse(contents(folder.summary()));
  const double exact = M_PI * M_PI * 10 / 16;
  CHECK(summary["unstable_from"].get<double>() > exact);
  CHECK(summary["unstable_from"].get<double>() < exact + 0.1 + 1e-9);
  CHECK(summary["warnings"].dump().find("1 direction") != std::string::npos);
}

TEST_CASE("modes: a hinged beam at (n pi / L)^2 sqrt(EI / rhoA); files that are there are kept") {
  const OwnFolder own;
  const std::string shapes = own.path / "shapes.xdmf", matrices = own.path / "matrices";
  const scene::Scene scene = parsed(beam(""));
  const std::string said = printed([&] { app::modes(scene, PETSC_COMM_WORLD, shapes, matrices, false); });
  std::istringstream lines(said);
  int found = 0;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string body;
    int mode = 0;
    double hertz = 0, omega = 0;
    if (!(words >> body >> mode >> hertz >> omega) || body != "beam") continue;
    ++found;
    const double exact = std::pow(mode * M_PI / 2, 2) * std::sqrt(10 / 3.);
    CHECK(omega == Approx(exact).epsilon(2e-5 * std::pow(mode, 4)));  // (n pi/8)^4/720 of n = 1: 3e-5
    CHECK(hertz == Approx(omega / (2 * M_PI)).epsilon(1e-5));
  }
  CHECK(found == 3);
  CHECK(std::filesystem::exists(shapes));
  CHECK(std::filesystem::is_directory(matrices));
  CHECK_THAT(said, Contains("Shapes: " + shapes) && Contains("Matrices: " + matrices));
  const std::string before = contents(shapes);
  CHECK(refusal([&] { app::modes(scene, PETSC_COMM_WORLD, shapes, {}, false); }) != "");
  CHECK(refusal([&] { app::modes(scene, PETSC_COMM_WORLD, {}, matrices, false); }) != "");
  CHECK(contents(shapes) == before);
  CHECK(refusal([&] { app::modes(scene, PETSC_COMM_WORLD, shapes, matrices, true); }) == "");
}

TEST_CASE("check: counts of elements, dofs, coordinates, multipliers and steps") {
  const std::string joints = "joints:\n  root: {type: revolute, between: [ground, beam.start]}\n";
  const std::string still = printed([&] { app::check(parsed(beam(joints)), PETSC_COMM_WORLD); });
  CHECK_THAT(still, Contains("30 coordinates and 2 multipliers of the full-order model") && Contains("no motion") &&
                        Contains("1 joints, 0 loads, 0 probes") && Contains("all 6 static derivatives"));
  const auto said = [&](const std::string& motion) {
    return printed([&] { app::check(parsed(beam(joints + motion)), PETSC_COMM_WORLD); });
  };
  CHECK_THAT(said("motion: {end: 0.5, step: 0.01}\n"), Contains("50 steps of 0.01 s"));
  CHECK_THAT(said("motion: {end: 0.5, step: 0.01, tolerance: 1e-4}\n"), Contains("tolerance 0.0001"));
  // the root's velocity does not fit its hinge
  const std::string flying = beam("    initial: {velocity: [0, 1]}\n" + joints);
  CHECK_THAT(printed([&] { app::check(parsed(flying), PETSC_COMM_WORLD); }), Contains("contradict the joints"));
  CHECK_THAT(still, !Contains("violate the joints"));
  const std::string driven = beam("joints: {hub: {type: driven, between: [ground, beam.start], angle: \"5*t\"}}\n");
  CHECK_THAT(printed([&] { app::check(parsed(driven + "motion: {end: 0.5, step: 0.01}\n"), PETSC_COMM_WORLD); }),
             Contains("joints and drives (at t = 0: hub 5 rad/s)"));
}

TEST_CASE("reduce and info: the file says what it was made of") {
  const OwnFolder own;
  const std::string path = own.path / "beam.h5";
  const scene::Scene scene = parsed(beam(""));
  CHECK_THAT(refusal([&] { app::reduce(scene, "rod", PETSC_COMM_WORLD, path, false); }), Contains("rod"));
  CHECK_FALSE(std::filesystem::exists(path));
  const std::string made = printed([&] { app::reduce(scene, "", PETSC_COMM_WORLD, path, false); });
  const std::string constrained = printed([&] { app::info(path, PETSC_COMM_WORLD); });
  CHECK_THAT(constrained, Contains("beam") && Contains("27"));  // dofs
  CHECK(made.starts_with(constrained));
  CHECK_THAT(made, Contains("Reduced body: " + path));
  CHECK(refusal([&] { app::reduce(scene, "beam", PETSC_COMM_WORLD, path, false); }) != "");
  CHECK(refusal([&] { app::reduce(scene, "beam", PETSC_COMM_WORLD, path, true); }) == "");
  own.write("no.h5", "not one");
  CHECK(refusal([&] { app::info(own.path / "no.h5", PETSC_COMM_WORLD); }) != "");
}
