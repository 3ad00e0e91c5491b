#include "../../../src/app/stress.h"

#include "../../../src/app/equilibrium.h"
#include "command_tests.h"

// A cantilever of 2 m, A = 1e-3 m^2, I = 1e-7 m^4, c = 0.02 m, under 500 N along it and 3 N across: N / A + M c / I.
TEST_CASE("stress: the maximum at the root, and a history elsewhere") {
  const OwnFolder own;
  const std::string text =
      "bodies:\n  beam:\n    mesh: {line: {from: [0, 0], to: [2, 0], elements: 10}}\n"
      "    section: {A: 1e-3, I: 1e-7, fibre: 0.02}\n    material: {E: 2e11, rho: 7800}\n"
      "    frame: {type: clamped, at: start}\n    reduction: {modes: 4, attachment: all}\njoints: {root: {type: fixed, "
      "between: [ground, beam.start]}}\n"
      "loads: {tip: {type: force, at: beam.end, force: [\"500*t\", \"-3*t\"]}}\nmotion: {end: 1, step: 0.1}\n";
  const std::string file = own.write("scene.yaml", text);
  const auto folder = own.results("out");
  printed([&] {
    app::solve_static(scene::read_scene(file), scene::Formulation::lffr, PETSC_COMM_WORLD, {1, 4}, folder, false);
  });
  app::StressRequest request;
  request.folder = folder.path;
  const std::string said = printed([&] { app::stress(request, PETSC_COMM_WORLD); });
  CHECK_THAT(said, Contains("1.7e+06"));
  CHECK_THAT(said, Contains("5 instants, 1 of them with fields, 10 elements of beam"));
  request.force = true, request.frames = 2, request.histories = {"beam:0.9,0,0"};
  printed([&] { app::stress(request, PETSC_COMM_WORLD); });
  const auto columns = columns_of(folder.path / "stress.csv");
  REQUIRE(columns.at("t [s]").size() == 5);
  const auto& largest = columns.at("beam.1.stress_max [Pa]");
  for (int i = 0; i < 5; ++i)  // of the element from 0.8 to 1 at its start
    CHECK(std::stod(largest[i]) == Approx(0.25 * i * (5e5 + 3 * 1.2 * 0.02 / 1e-7)).epsilon(5e-3).margin(1));
  const auto refusal = [&](const app::StressRequest& wrong) {
    try {
      printed([&] { app::stress(wrong, PETSC_COMM_WORLD); });
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  auto wrong = request;
  wrong.histories = {"bar:1,0,0"};
  CHECK_THAT(refusal(wrong), Contains("bar:1,0,0: names no body with stresses"));
  wrong = request, wrong.at = {3};
  CHECK_THAT(refusal(wrong), Contains("--at 3: is not within the simulation"));
  wrong = request, wrong.force = false;
  CHECK_THAT(refusal(wrong), Contains("exists"));
  wrong = request, wrong.sources = {"beam:scene.yaml"};
  CHECK_THAT(refusal(wrong), Contains("names no body from a file"));
  own.write("scene.yaml", text + "title: another\n");
  CHECK_THAT(refusal(request), Contains("has changed since the run"));
  std::filesystem::remove(own.path / "scene.yaml");
  CHECK_THAT(refusal(request), Contains("is not there; expected it, or --scene FILE"));
}
