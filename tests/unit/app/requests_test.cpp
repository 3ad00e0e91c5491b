#include <cmath>

#include "../../../src/app/campbell.h"
#include "../../../src/app/run.h"
#include "../../../src/app/sweep.h"
#include "command_tests.h"

namespace {

double number(const std::string& word) { return std::stod(word); }

app::Varied varied(const std::string& path, int count) {
  app::Varied one{path, {}};
  for (int i = 1; i <= count; ++i) one.values.push_back(i);
  return one;
}

}  // namespace

TEST_CASE("values: ranges with their end, lists as they stand, nothing that never arrives") {
  CHECK(app::parse_speeds("0:1:0.25") == std::vector<double>{0, 0.25, 0.5, 0.75, 1});
  CHECK(app::parse_speeds("0:0.9:0.25") == std::vector<double>{0, 0.25, 0.5, 0.75});
  CHECK(app::parse_speeds("3:3:1") == std::vector<double>{3});
  CHECK(app::parse_speeds("5, -1 ,5") == std::vector<double>{5, -1, 5});
  CHECK(app::parse_speeds("0:10000:1").size() == 10001);
  for (const char* wrong :
       {"", "1,,2", "1:2", "1:2:3:4", "0:1:-1", "0:1:0", "0:10001:1", "a", "1;2", "0:inf:1", "nan"}) {
    INFO(wrong);
    CHECK_THROWS_AS(app::parse_speeds(wrong), InputError);
  }
  std::string many = "0";
  for (int i = 1; i < 10000; ++i) many += ",1";
  CHECK(app::parse_speeds(many).size() == 10000);
  CHECK_THROWS_WITH(app::parse_speeds(many + ",1"), Contains("more than 10000"));
}

TEST_CASE("points: two or three numbers, in brackets or not") {
  CHECK(app::parse_point("1,2,3", "--about") == Eigen::Vector3d(1, 2, 3));
  CHECK(app::parse_point("[1, -2]", "--about") == Eigen::Vector3d(1, -2, 0));
  for (const char* wrong : {"", "1", "1,2,3,4", "[1,2", "1,2]", "x,y,z", "[]"}) {
    INFO(wrong);
    CHECK_THROWS_WITH(app::parse_point(wrong, "--about"), Contains("--about"));
  }
}

TEST_CASE("what is varied: a path and its values") {
  const app::Varied list = app::parse_varied("loads.tip.force[2]=1,3");
  CHECK(list.path == "loads.tip.force[2]");
  CHECK(list.values == std::vector<double>{1, 3});
  CHECK(app::parse_varied("F=0:1:0.5").values == std::vector<double>{0, 0.5, 1});
  for (const char* wrong : {"", "F", "=1,2", "F=", "F=1:2"}) {
    INFO(wrong);
    CHECK_THROWS_WITH(app::parse_varied(wrong), Contains("--vary"));
  }
}

TEST_CASE("members: every combination with the last parameter fastest, or one after another together") {
  const auto all = app::members_of({varied("a", 2), varied("b", 3)}, false);
  REQUIRE(all.size() == 6);
  for (std::size_t m = 0; m < 6; ++m) {
    REQUIRE(all[m].size() == 2);
    CHECK((all[m][0].path == "a" && all[m][0].value == static_cast<double>(m / 3 + 1)));
    CHECK((all[m][1].path == "b" && all[m][1].value == static_cast<double>(m % 3 + 1)));
  }
  const auto paired = app::members_of({varied("a", 3), varied("b", 3)}, true);
  REQUIRE(paired.size() == 3);
  for (std::size_t m = 0; m < 3; ++m) CHECK((paired[m][0].value == m + 1. && paired[m][1].value == m + 1.));
  CHECK_THROWS_WITH(app::members_of({varied("a", 3), varied("b", 2)}, true), Contains("a has 3 values and b has 2"));
  CHECK_THROWS_WITH(app::members_of({varied("a", 3), varied("a", 3)}, false), Contains("a is varied twice"));
  CHECK(app::members_of({varied("a", 1000), varied("b", 1000)}, false).size() == 1000000);
  CHECK_THROWS_WITH(app::members_of({varied("a", 1001), varied("b", 1000)}, false), Contains("1001000 members"));
}

// x = F t^2 / 2 m, m = 6 kg, exact in steps of a constant acceleration; root of the mean square F t^2 / (2 m sqrt 5).
TEST_CASE("sweep: a pushed rod, each member by its closed form") {
  const OwnFolder own;
  const std::string file = own.write("scene.yaml", R"yaml(
parameters: {F: 1}
bodies:
  rod:
    rigid: true
    frame: mean-axis
    mesh: {line: {from: [-1, 0], to: [1, 0], elements: 2}}
    section: {rhoA: 3}
loads: {push: {type: force, at: {body: rod, node: [0, 0]}, force: [F, 0]}}
motion: {end: 2, step: 0.01}
probes: {middle: {at: {body: rod, node: [0, 0]}, quantity: displacement}}
)yaml");
  const auto folder = own.results("out");
  const std::string said = printed([&] {
    app::sweep({.scene = file,
                .formulation = scene::Formulation::vm_md,
                .varied = {{"F", {3, -6}}, {"bodies.rod.section.rhoA", {3, 6}}}},
               PETSC_COMM_WORLD, folder);
  });
  const auto columns = columns_of(folder.sweep_table());
  REQUIRE(columns.at("member").size() == 4);
  for (std::size_t m = 0; m < 4; ++m) {
    const double force = m < 2 ? 3 : -6, mass = m % 2 == 0 ? 6 : 12, last = force * 4 / (2 * mass);
    CHECK(number(columns.at("member")[m]) == static_cast<double>(m + 1));
    CHECK(number(columns.at("F")[m]) == force);
    CHECK(number(columns.at("failed")[m]) == 0);
    CHECK(number(columns.at("end [s]")[m]) == Approx(2));
    CHECK(number(columns.at("last middle.x [m]")[m]) == Approx(last).epsilon(1e-9));
    CHECK(number(columns.at("greatest middle.x [m]")[m]) == Approx(std::abs(last)).epsilon(1e-9));
    CHECK(number(columns.at("rms middle.x [m]")[m]) == Approx(std::abs(last) / std::sqrt(5)).epsilon(1e-4));
    CHECK(number(columns.at("last middle.y [m]")[m]) == Approx(0).margin(1e-12));
  }
  CHECK_THAT(said, Contains("4 members (0 failed)"));
  CHECK(nlohmann::json::parse(contents(folder.summary()))["status"] == "finished");
  const auto rigid = own.results("rigid");  // nothing to estimate, which is said once
  printed([&] {
    app::sweep({.scene = file, .formulation = scene::Formulation::vm_md, .varied = {{"F", {3, 6}}}, .estimate = true},
               PETSC_COMM_WORLD, rigid);
  });
  const auto warnings = nlohmann::json::parse(contents(rigid.summary()))["warnings"];
  REQUIRE(warnings.size() == 3);
  for (int i = 0; i < 3; ++i) {
    const std::string part = std::array{"reduction", "model", "mesh"}[i];
    CHECK_THAT(warnings[i]["text"].get<std::string>(),
               Contains("no estimate of the " + part + " error: no body is flexible"));
    CHECK(warnings[i]["members"] == nlohmann::json{1, 2});
  }
  const auto refused = [&](const std::vector<app::Varied>& what, scene::Formulation formulation) {
    app::sweep({.scene = file, .formulation = formulation, .varied = what}, PETSC_COMM_WORLD, own.results("no"));
  };
  CHECK_THROWS_WITH(
      refused({{"G", {1}}}, scene::Formulation::vm_md),
      Contains("expected a key of the scene or a parameter (parameters, bodies, loads, motion, probes, F)"));
  CHECK_THROWS_WITH(refused({{"motion.steps", {1}}}, scene::Formulation::vm_md),
                    Contains("expected a key of motion (end, step); did you mean \"step\"?"));
  CHECK_THROWS_WITH(refused({{"F", {1}}}, scene::Formulation::nlffr), Contains("nlffr"));
  CHECK_FALSE(std::filesystem::exists(own.path / "no"));
}

TEST_CASE("sweep: the total error of each member is that of its run") {
  const OwnFolder own;
  const std::string text = R"yaml(
parameters: {F: 1}
bodies:
  rod:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 6}}
    section: {EA: 1e5, EI: 5, rhoA: 1}
    reduction: {modes: 3}
joints: {clamp: {type: fixed, between: [ground, rod.start]}}
loads: {tip: {type: force, at: rod.end, force: [0, "F*sin(5*t)"]}}
motion: {end: 0.4, step: 4e-3}
probes: {tip: {at: rod.end}, turn: {at: rod.end, quantity: rotation}}
)yaml";
  const std::string file = own.write("scene.yaml", text);
  const auto folder = own.results("out");
  printed([&] {
    app::sweep({.scene = file, .formulation = scene::Formulation::vm_md, .varied = {{"F", {1, 8}}}, .estimate = true},
               PETSC_COMM_WORLD, folder);
  });
  const auto columns = columns_of(folder.sweep_table());
  app::RunPlan plan;
  plan.quiet = true, plan.estimate = true;
  for (std::size_t m = 0; m < 2; ++m) {
    const scene::Scene member = scene::parse_scene(text, "scene", {{"F", m == 0 ? 1. : 8.}});
    const auto total = app::run(member, scene::Formulation::vm_md, PETSC_COMM_SELF, std::nullopt, plan)
                           .summary["estimate"]["total"]["probes"];
    for (const std::string probe : {"tip", "turn"}) {
      const double error = number(columns.at("estimated error " + probe + " [-]")[m]);
      CHECK(error > 0);
      CHECK(error == Approx(total[probe].get<double>()).epsilon(1e-6));
    }
  }
}

// A rigid rod of length L hinged at the distance e from the axis lags at omega = Omega sqrt(3 e / 2 L).
TEST_CASE("campbell: the table of a hinged rod") {
  const OwnFolder own;
  const auto folder = own.results("out");
  const scene::Scene scene = scene::parse_scene(R"yaml(
bodies:
  hub:
    rigid: true
    mesh: {line: {from: [0, 0], to: [0.5, 0], elements: 1}}
    section: {rhoA: 1}
  rod:
    rigid: true
    mesh: {line: {from: [0.5, 0], to: [2.5, 0], elements: 1}}
    section: {rhoA: 1}
joints:
  hub: {type: driven, between: [ground, hub.start], angle: "t"}
  hinge: {type: revolute, between: [hub.end, rod.start]}
)yaml",
                                                "scene.yaml");
  app::CampbellRequest request;
  request.speeds = "2,10";
  const std::string said =
      printed([&] { app::campbell_one(scene, scene::Formulation::vm_md, PETSC_COMM_WORLD, request, folder); });
  const auto columns = columns_of(folder.path / "campbell.csv");
  REQUIRE(columns.at("speed [rad/s]").size() == 2);
  for (std::size_t i = 0; i < 2; ++i) {
    const double speed = i == 0 ? 2 : 10, exact = speed * std::sqrt(0.375);
    CHECK(number(columns.at("speed [rad/s]")[i]) == speed);
    CHECK(number(columns.at("frequency [rad/s]")[i]) == Approx(exact).epsilon(1e-8));
    CHECK(number(columns.at("frequency [Hz]")[i]) == Approx(exact / (2 * M_PI)).epsilon(1e-8));
  }
  const auto summary = nlohmann::json::parse(contents(folder.summary()));
  CHECK(summary["axis"]["about"] == nlohmann::json{0., 0., 1.});
  CHECK(summary["speeds"][1]["rad_per_s"] == 10);
  CHECK_THAT(said, Contains("about (0, 0, 1) through (0, 0, 0)"));
}
