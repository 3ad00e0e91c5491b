#include "../../../src/app/choose.h"

#include "../../../src/app/commands.h"
#include "../../../src/app/compare_table.h"
#include "command_tests.h"

namespace {

/// A cantilever whose tip goes to a fifth of its length, EI = L = rhoA = 1.
const std::string beam = R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 6}}
    section: {EA: 1e5, EI: 1, rhoA: 1}
    reduction: {modes: 3}
joints: {clamp: {type: fixed, between: [ground, beam.start]}}
loads: {tip: {type: force, at: beam.end, force: [0, "0.6*sin(2*t)"]}}
motion: {end: 0.8, step: 0.01}
probes: {tip: {at: beam.end}}
)yaml";

app::Series exact(Formulation formulation, int elements) {
  scene::Scene scene = scene::parse_scene(beam, "scene.yaml");
  scene.bodies[0].mesh.elements = {elements};
  scene.motion.step /= 4, scene.motion.every *= 4;
  app::RunPlan quiet;
  quiet.quiet = true, quiet.check_range = false;
  return app::run(scene, formulation, PETSC_COMM_WORLD, std::nullopt, quiet).series;
}

app::Series chosen(const scene::Accuracy& accuracy, const OwnFolder& own, std::string& said) {
  const auto folder = own.results(accuracy.total ? "total" : "reduction");
  const std::string scene = own.path / (accuracy.total ? "total.yaml" : "reduction.yaml");
  said = printed([&] {
    app::run_chosen(scene::parse_scene(beam, "scene.yaml"), accuracy, PETSC_COMM_WORLD, folder, scene, false);
  });
  CHECK(std::filesystem::exists(scene));
  app::Series series;
  series.columns = {{"tip.x", "m"}, {"tip.y", "m"}};
  const auto columns = testing::columns_of(folder.probes());
  for (std::size_t i = 0; i < columns.at("t [s]").size(); ++i) {
    series.t.push_back(std::stod(columns.at("t [s]")[i]));
    series.values.push_back({std::stod(columns.at("tip.x [m]")[i]), std::stod(columns.at("tip.y [m]")[i])});
  }
  return series;
}

}  // namespace

TEST_CASE("run with an accuracy: the selected model is as close to the full-order model as required") {
  const OwnFolder own;
  std::string said;
  const app::Series series = chosen({0.02, false}, own, said);
  CHECK(app::worst_error(series, exact(Formulation::nlffr, 6)) < 0.02);
  const auto j = nlohmann::json::parse(contents(own.path / "reduction/summary.json"));
  CHECK(j["accuracy"]["supported"].get<double>() <= 0.02);
  CHECK_THAT(said, Contains("basis"));
}

TEST_CASE("run with a total accuracy: the selected model is as close to geometrically exact beams as required") {
  const OwnFolder own;
  std::string said;
  const app::Series series = chosen({0.02, true}, own, said);
  CHECK(app::worst_error(series, exact(Formulation::cfr, 48)) < 0.02);
  CHECK_THAT(said, Contains("error before") && Contains("error after"));
}

TEST_CASE("run with a total accuracy: the total of bodies that became rigid is marked") {
  const OwnFolder own;
  const std::string said = printed([&] {
    app::run_chosen(scene::parse_scene(R"yaml(
bodies:
  arm:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 4}}
    section: {EA: 1e9, EI: 1e7, rhoA: 1}
    reduction: {modes: 2}
joints: {hinge: {type: revolute, between: [ground, arm.start]}}
gravity: [0, -9.81]
motion: {end: 0.1, step: 1e-3}
probes: {tip: {at: arm.end, quantity: position}}
)yaml",
                                       "scene.yaml"),
                    {0.05, true}, PETSC_COMM_WORLD, own.results("rigid"), std::nullopt, false);
  });
  CHECK_THAT(said, Contains(" *\n* total without the deformation of bodies that the selection made rigid: arm\n"));
  CHECK_THAT(said, Contains("total of the known parts"));
  const auto total = nlohmann::json::parse(contents(own.path / "rigid/summary.json"))["estimate"]["total"];
  CHECK(total["missing"]["tip"].dump() == R"(["reduction","model","mesh"])");
  CHECK(total["made_rigid"].dump() == R"(["arm"])");
}

// It cannot be rigid, and keeps one basis vector: so does the scene that is written.
TEST_CASE("run with an accuracy: the written scene of a body that begins deformed is the model that was simulated") {
  const OwnFolder own;
  const std::string path = own.path / "written.yaml",
                    said = printed([&] {
                      app::run_chosen(scene::parse_scene(R"yaml(
bodies:
  rod:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 8}}
    section: {EA: 1e4, EI: 1, rhoA: 1}
    initial: {deformation: [0, "0.05*x^2"]}
joints: {root: {type: fixed, between: [ground, rod.start]}}
motion: {end: 0.5, step: 0.01}
probes: {tip: {at: rod.end}}
)yaml",
                                                         "scene.yaml"),
                                      {0.2, true}, PETSC_COMM_WORLD, own.results("deformed"), path, false);
                    });
  CHECK_THAT(said, !Contains("made rigid"));
  CHECK_THAT(said, Contains("initial.deformation of rod"));  // a warning on the scene
  const auto columns = testing::columns_of(own.path / "deformed/probes.csv");
  app::RunPlan quiet;
  quiet.quiet = true, quiet.check_range = false;
  const app::Series again =
      app::run(scene::read_scene(path), Formulation::vm_md, PETSC_COMM_WORLD, std::nullopt, quiet).series;
  REQUIRE(again.t.size() == columns.at("t [s]").size());
  for (std::size_t i = 0; i < again.t.size(); ++i)
    CHECK(again.values[i][1] == Approx(std::stod(columns.at("tip.y [m]")[i])).margin(1e-9));
}
