#include "../../../src/app/compare.h"

#include "command_tests.h"

namespace {

/// A cantilever whose tip goes to a tenth of its length, EI = L = rhoA = 1.
std::string cantilever(const std::string& more = "") {
  return "bodies:\n  beam:\n    mesh: {line: {from: [0, 0], to: [1, 0], elements: 6}}\n"
         "    section: {EA: 1e5, EI: 1, rhoA: 1}\n    frame: {type: clamped, at: start}\n    reduction: {modes: 3}\n" +
         more +
         "joints: {clamp: {type: fixed, between: [ground, beam.start]}}\n"
         "loads: {tip: {type: force, at: beam.end, force: [0, \"0.3*sin(2*t)\"]}}\n"
         "motion: {end: 0.8, step: 0.02}\nprobes: {tip: {at: beam.end}}\n";
}

}  // namespace

TEST_CASE(
    "compare: modes with derivatives follow the full-order model, linear elastic forces do not shorten the beam") {
  const OwnFolder own;
  const scene::Scene scene = scene::parse_scene(cantilever(), "scene.yaml");
  const auto path = own.path / "out";
  const std::string said = printed([&] {
    app::compare(scene, {Formulation::nlffr, Formulation::vm_md, Formulation::lffr}, PETSC_COMM_WORLD, path, false,
                 true);
  });
  const auto columns = columns_of(path / "compare.csv");
  const std::vector<std::string>& names = columns.at("formulation");
  REQUIRE(names.size() == 4);
  CHECK((names[0] == "nlffr" && names[1] == "vm+md" && names[2] == "lffr"));
  const auto& along = columns.at("tip.x vs nlffr [%]");
  CHECK(along[0].empty());
  CHECK(std::stod(along[1]) < 0.5);
  CHECK(std::stod(along[2]) == Approx(100).epsilon(0.05));  // the tip stays at its distance from the root
  const auto j = nlohmann::json::parse(contents(path / "compare.json"));
  CHECK(j["reference"] == "nlffr");
  CHECK(j["runs"].size() == 3);
  CHECK(j["errors"]["nlffr"]["vm+md"]["tip.y"].get<double>() < 5e-3);
  CHECK(j["reference_error"]["tip.x"].get<double>() < 1e-2);  // from half the step and mesh
  CHECK_THAT(said, Contains("The last row is the error of the reference itself, nlffr"));
  for (const char* name : {"nlffr", "vm+md", "lffr"}) CHECK(std::filesystem::exists(path / name / "probes.csv"));
  CHECK_THROWS_WITH(app::compare(scene, {Formulation::vm}, PETSC_COMM_WORLD, path, false, false),
                    Contains("is not empty"));
}

TEST_CASE("compare: a formulation that stops is marked, the others are compared") {
  const OwnFolder own;
  // linear elastic forces in a rotating frame grow without limit beyond gamma = 3.516
  const scene::Scene scene = scene::parse_scene(R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 4}}
    section: {EA: 1e5, EI: 1, rhoA: 1}
    frame: {type: clamped, at: start}
    initial: {angular_velocity: 8}
    reduction: {modes: 2}
joints: {hub: {type: driven, between: [ground, beam.start], angle: "8*t"}}
loads: {tip: {type: force, at: beam.end, force: [0, 1e-3]}}
motion: {end: 12, step: 0.01}
probes: {tip: {at: beam.end}}
)yaml",
                                                "scene.yaml");
  const auto path = own.path / "out";
  std::string why;
  const std::string said = printed([&] {
    try {
      app::compare(scene, {Formulation::vm_md, Formulation::lffr}, PETSC_COMM_WORLD, path, false, false);
    } catch (const RunError& error) {
      why = error.what();
    }
  });
  CHECK_THAT(why, Contains("lffr"));
  CHECK_THAT(said, Contains("Failed (lffr): "));
  const auto columns = columns_of(path / "compare.csv");
  CHECK(columns.at("model")[1] == "failed");
  const auto j = nlohmann::json::parse(contents(path / "compare.json"));
  CHECK(j["stopped"][0]["name"] == "lffr");
  CHECK(j["runs"].size() == 1);
}

TEST_CASE("compare: the formulations of a scene, each once") {
  const auto of = [](const std::string& more, const std::vector<std::string>& names = {}) {
    return app::formulations_to_compare(scene::parse_scene(cantilever(more), "scene.yaml"), names);
  };
  for (const char* more : {"", "    damping: {modal: [0.01]}\n"})
    CHECK(of(more) ==
          std::vector{Formulation::cfr, Formulation::nlffr, Formulation::lffr, Formulation::vm, Formulation::vm_md});
  CHECK(of("", {"vm", "cfr"}) == std::vector{Formulation::vm, Formulation::cfr});
  CHECK_THROWS_WITH(of("", {"vm", "vm"}), Contains("\"vm\" is given twice"));
  CHECK_THROWS_AS(of("", {"fem"}), InputError);
}
