#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>

#include "building.h"

using namespace floe;
using scene::Formulation;
using testing::built;

namespace {

using Kind = reduction::ColumnOrigin::Kind;

std::string cantilever(const std::string& reduction) {
  return R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [100, 0], elements: 10}}
    section: {A: 70, I: 585}
    material: {E: 16000, rho: 0.0078}
    reduction: )yaml" +
         reduction + R"yaml(
joints:
  clamp: {type: fixed, between: [ground, beam.start]}
loads:
  tip: {type: force, at: beam.end, force: [0, "2500*sin(9.5*t)"]}
motion: {end: 0.2, step: 0.01}
probes:
  tip: {at: beam.end}
)yaml";
}

std::vector<std::string> labels(const assembly::Model& model, Kind kind) {
  std::vector<std::string> all;
  for (const auto& origin : model.bodies[0].origins)
    if (origin.kind == kind) all.push_back(origin.label);
  return all;
}

}  // namespace

TEST_CASE("vm+md holds modes and their derivatives, vm as many modes as these have columns") {
  const assembly::Model both = built(cantilever("{modes: 3, derivatives: all}"), Formulation::vm_md);
  CHECK(labels(both, Kind::mode) == std::vector<std::string>{"mode 1", "mode 2", "mode 3"});
  CHECK(labels(both, Kind::derivative).size() == 6);
  CHECK(both.bodies[0].columns == 8);                               // mode 3 is axial: it has no derivative with itself
  CHECK(both.bodies[0].omega[0] == Approx(1.45295).epsilon(1e-4));  // the paper's cantilever, rotary inertia included
  const assembly::Model alone = built(cantilever("{modes: 3, derivatives: all}"), Formulation::vm);
  CHECK(alone.bodies[0].columns == 8);  // what vm+md keeps, not what it asked for
  CHECK(labels(alone, Kind::derivative).empty());
  CHECK(built(cantilever("{modes: {count: 3, alone: 5}}"), Formulation::vm).bodies[0].columns == 5);
}

TEST_CASE("vm stands on as many columns as vm+md keeps, however the derivatives are chosen") {
  const std::string reduction =
      GENERATE("{modes: 4, derivatives: 4}", "{modes: 8, derivatives: all}",
               "{modes: 3, derivatives: all, derivative_type: full}", "{modes: 4, derivatives: [[1, 1], [3, 3]]}",
               "{modes: {count: 3, of: frame}, derivatives: all, attachment: all}");
  INFO(reduction);
  const int both = built(cantilever(reduction), Formulation::vm_md).bodies[0].columns;
  CHECK(built(cantilever(reduction), Formulation::vm).bodies[0].columns == both);
}

// Bending modes 1, 2, 4 carry the motion; (1,3) and (2,3) of the axial mode 3 have great norms, but the modes span
// them.
TEST_CASE("derivatives by count take pairs that add something") {
  const assembly::Model model = built(cantilever("{modes: 8, derivatives: 3}"), Formulation::vm_md);
  const auto chosen = labels(model, Kind::derivative);
  REQUIRE(chosen.size() == 3);
  for (const auto& label : chosen) CHECK(label.find('3') == std::string::npos);
  for (const auto& origin : model.bodies[0].origins)
    if (origin.kind == Kind::derivative) CHECK(origin.new_part > 1e-3);
}

TEST_CASE("derivatives by pairs, by count and none") {
  const assembly::Model pairs = built(cantilever("{modes: 4, derivatives: [[1, 1], [1, 4]]}"), Formulation::vm_md);
  CHECK(labels(pairs, Kind::derivative) == std::vector<std::string>{"derivative 1,1", "derivative 1,4"});
  const assembly::Model none = built(cantilever("{modes: 4, derivatives: none}"), Formulation::vm_md);
  CHECK(labels(none, Kind::derivative).empty());
  const assembly::Model count = built(cantilever("{modes: 4, derivatives: 3}"), Formulation::vm_md);
  REQUIRE(labels(count, Kind::derivative).size() == 3);
  double before = 1;  // ranked, the greatest first
  for (const auto& origin : count.bodies[0].origins) {
    if (origin.kind != Kind::derivative) continue;
    CHECK((origin.interaction > 0 && origin.interaction <= before));
    before = origin.interaction;
  }
  CHECK(labels(count, Kind::derivative)[0].find('3') == std::string::npos);  // mode 3 is axial: it hardly moves
}

TEST_CASE("full derivatives bring both orders of a pair") {
  const assembly::Model model =
      built(cantilever("{modes: 2, derivatives: all, derivative_type: full}"), Formulation::vm_md);
  auto all = labels(model, Kind::derivative);
  std::sort(all.begin(), all.end());
  CHECK(all == std::vector<std::string>{"derivative 1,1", "derivative 1,2", "derivative 2,1", "derivative 2,2"});
}

TEST_CASE("modes that cannot carry a joint's moment are warned of by the names of body and joint") {
  using Catch::Contains;
  const auto warnings = [](const std::string& reduction) {
    std::string all;
    for (const auto& warning : built(cantilever(reduction), Formulation::vm_md).warnings) all += warning + "\n";
    return all;
  };
  CHECK_THAT(warnings("{modes: {count: 3, of: frame}, attachment: none}"), Contains("beam") && Contains("joint clamp"));
  CHECK(warnings("{modes: {count: 3, of: frame}}").empty());  // attachment columns at the joints
  CHECK(warnings("{modes: 3, attachment: none}").empty());    // modes of the body as its joints hold it
}

TEST_CASE("a moment that turns a hinge has a column by default") {
  const auto columns = [](const std::string& place) {
    return labels(built(R"yaml(
bodies:
  arm:
    mesh: {line: {from: [0, 0], to: [10, 0], elements: 10}}
    section: {EA: 4.8e4, EI: 1e3, rhoA: 1}
    reduction: {modes: 2, derivatives: none}
joints: {hinge: {type: revolute, between: [ground, arm.start]}}
loads: {drive: {type: moment, at: arm.)yaml" +
                            place + R"yaml(, moment: t}}
motion: {end: 0.1, step: 0.01}
)yaml",
                        Formulation::vm_md),
                  Kind::attachment);
  };
  CHECK(columns("start") == std::vector<std::string>{"attachment drive.moment"});
  CHECK(columns("end").empty());
}

// A spring at one corner of the edge or at the other: which node of the edge is its first one is no matter.
TEST_CASE("a moment on an edge has columns where a joint is at any of its nodes") {
  for (const char* corner : {"p2", "p3", "p1"}) {
    const auto columns = labels(built(fmt::format(R"yaml(
bodies:
  plate:
    mesh: {{plate: {{along: [0.4, 0, 0], across: [0, 0.2, 0], elements: [4, 2]}}}}
    section: {{thickness: 0.002}}
    material: {{E: 7e10, nu: 0.3, rho: 2700}}
    reduction: {{modes: 2, derivatives: none}}
joints:
  root: {{type: fixed, between: [ground, plate.left]}}
  spring: {{type: spring, between: [{{body: ground, node: [0.4, 0.1, 0.2]}}, plate.{}], stiffness: 50}}
loads: {{m: {{type: moment, at: plate.right, moment: [t, 0, 0]}}}}
motion: {{end: 0.1, step: 0.01}}
)yaml",
                                                  corner),
                                      Formulation::vm_md),
                                Kind::attachment);
    INFO(corner);
    CHECK((std::count(columns.begin(), columns.end(), "attachment m.mx") == 1) == (std::string(corner) != "p1"));
  }
}

TEST_CASE("attachment columns stand where joints or loads act") {
  const auto of = [](const std::string& reduction) {
    return labels(built(cantilever(reduction), Formulation::vm_md), Kind::attachment);
  };
  CHECK(of("{modes: 2, derivatives: none}").empty());  // the ground's joint is in the modes already
  const auto joints = of("{modes: {count: 2, of: frame}, derivatives: none}");
  CHECK(std::count(joints.begin(), joints.end(), "attachment clamp.moment") == 1);
  const auto loads = of("{modes: 2, derivatives: none, attachment: loads}");
  CHECK(std::count(loads.begin(), loads.end(), "attachment tip.fy") == 1);
}

TEST_CASE("more modes than elastic dofs are an input error at the key") {
  CHECK_THAT(testing::complaint(cantilever("{modes: 400}"), Formulation::vm_md), Catch::Contains("test.yaml:"));
}

TEST_CASE("body_modes gives frequencies and residuals as the reduction asks") {
  const auto scene = scene::parse_scene(cantilever("{modes: 5}"), "test.yaml");
  const auto reports = assembly::body_modes(scene, PETSC_COMM_WORLD);
  REQUIRE(reports.size() == 1);
  CHECK(reports[0].name == "beam");
  CHECK(reports[0].dofs == 33);
  REQUIRE(reports[0].omega.size() == 5);
  CHECK(reports[0].omega[1] == Approx(9.00192).epsilon(1e-3));
  for (double residual : reports[0].residual) CHECK(residual < 1e-8);
}

TEST_CASE("products of coordinates: all, or as few as the scene says") {
  const auto report = [](const std::string& reduction) {
    return built(R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: 10}}
    section: {shape: rectangle, width: 0.02, height: 0.01, orientation: [0, 0, 1]}
    material: {E: 2.1e11, nu: 0.3, rho: 7850}
    reduction: )yaml" +
                     reduction + R"yaml(
joints: {root: {type: fixed, between: [ground, beam.start]}}
motion: {end: 0.1, step: 0.01}
)yaml",
                 Formulation::vm_md)
        .bodies[0];
  };
  const assembly::BodyReport all = report("{modes: 6}"), few = report("{modes: 6, products: 3 %}");
  // every pair of the basis vectors with slope; those that stretch or twist the beam alone may have none
  int sloped = 0;
  while (sloped * (sloped + 1) / 2 < all.products) ++sloped;
  CHECK(sloped * (sloped + 1) / 2 == all.products);
  CHECK(sloped > 6);
  CHECK(sloped <= all.columns);
  CHECK(all.omitted_products == 0);
  CHECK(report("{modes: 6, products: all}").products == all.products);
  CHECK(few.omitted_products > 0);
  CHECK(few.products + few.omitted_products == all.products);
  CHECK(report("{modes: 6, elastic_force: linear}").products == 0);
}
