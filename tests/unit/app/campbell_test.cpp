#include "../../../src/app/campbell.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "../../../src/app/campbell_tracks.h"
#include "command_tests.h"
#include "floe/assembly/reduced_bodies_file.h"
#include "spatial_scene.h"

using namespace floe::app;

namespace {

/// L = EI = rhoA = 1 on a driven root; in space as stiff in both directions, about z.
std::string planar(const std::string& joint = "type: driven, angle: \"2*t\"", const std::string& modes = "6") {
  return "bodies:\n  beam:\n    mesh: {line: {from: [0, 0], to: [1, 0], elements: 8}}\n"
         "    section: {EA: 1e6, EI: 1, rhoA: 1}\n    frame: {type: clamped, at: start}\n    reduction: {modes: " +
         modes + "}\njoints: {root: {" + joint + ", between: [ground, beam.start]}}\n";
}
std::string spatial(const std::string& joint, const std::string& modes = "6") {
  return "bodies:\n  beam:\n    mesh: {line: {from: [0, 0, 1], to: [1, 0, 1], elements: 8}}\n"
         "    section: {A: 1, Iy: 1e-6, Iz: 1e-6, J: 2e-6, orientation: [0, 1, 0]}\n"
         "    material: {E: 1e6, G: 4e5, rho: 1}\n    reduction: {modes: " +
         modes + "}\njoints: {root: {" + joint + ", between: [ground, beam.start]}}\n";
}

CampbellDiagram diagram(const std::string& text, Formulation formulation, const CampbellRequest& request) {
  std::exception_ptr fault;
  CampbellDiagram found = campbell(scene::parse_scene(text, "scene"), formulation, PETSC_COMM_WORLD, request, fault);
  if (fault) std::rethrow_exception(fault);
  return found;
}

CampbellRequest at(const std::string& speeds, int modes, bool estimate = false) {
  CampbellRequest request;
  request.speeds = speeds, request.modes = modes, request.estimate = estimate;
  return request;
}

// First flap frequencies of a clamped beam, hub radius 0, at Omega = 0, 2, 6; lag: sqrt(flap^2 - Omega^2).
constexpr double flap[] = {3.5160153, 4.1373196, 7.3603730};

}  // namespace

TEST_CASE("campbell: a driven beam in the plane, in every formulation; its estimated error is small") {
  for (const auto formulation : {Formulation::nlffr, Formulation::vm_md}) {
    INFO(scene::name_of(formulation));
    const CampbellDiagram found = diagram(planar(), formulation, at("0,2,6", 2, true));
    REQUIRE(found.points.size() == 3);
    for (int s = 0; s < 3; ++s) {
      REQUIRE(found.points[s].fault == "");
      const double omega = found.points[s].vibrations.at(0).omega, speed = s == 0 ? 0 : s == 1 ? 2 : 6;
      CHECK(omega == Approx(std::sqrt(flap[s] * flap[s] - speed * speed)).epsilon(4e-3));
      CHECK(found.points[s].vibrations[0].track == 1);
    }
    CHECK(found.axis.direction == Eigen::Vector3d::UnitZ());
    CHECK(found.estimate.errors.empty() == (formulation == Formulation::nlffr));
    for (const FrequencyError& one : found.estimate.errors) CHECK(one.relative < 1e-3);
    if (formulation == Formulation::vm_md) CHECK(found.estimate.coordinates > found.model.coordinates);
  }
}

TEST_CASE("campbell: a driven beam in space flaps and lags, by any way to name the axis") {
  const std::string driven = spatial("type: driven, axis: [0, 0, 2], angle: \"t\"");
  CampbellRequest named = at("2", 2);
  named.about = "[0,0,3]", named.through = "0,0,1";
  for (const auto formulation : {Formulation::nlffr, Formulation::cfr}) {
    const CampbellDiagram by_joint = diagram(driven, formulation, at("2", 2)),
                          by_hand = diagram(driven, formulation, named);
    CHECK((by_joint.axis.point - Eigen::Vector3d(0, 0, 1)).norm() < 1e-12);
    CHECK((by_joint.axis.direction - by_hand.axis.direction).norm() < 1e-15);
    for (const auto* found : {&by_joint, &by_hand}) {
      REQUIRE(found->points.at(0).fault == "");
      CHECK(found->points[0].vibrations.at(0).omega == Approx(std::sqrt(flap[1] * flap[1] - 4)).epsilon(3e-3));
      CHECK(found->points[0].vibrations.at(1).omega == Approx(flap[1]).epsilon(3e-3));
    }
  }
}

TEST_CASE("campbell: axes that are missing or wrong are refused with what was expected") {
  const std::string driven = "type: driven, angle: \"t\"";
  const auto refusal = [](const std::string& text, const CampbellRequest& request,
                          Formulation formulation = Formulation::vm_md) {
    try {
      diagram(text, formulation, request);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CampbellRequest request = at("1", 1);
  CHECK_THAT(refusal(planar(), request, Formulation::cfr), Contains("cfr has no rotating frames in the plane"));
  request.about = "0,0,0";
  CHECK_THAT(refusal(planar(), request), Contains("--about: is the zero vector"));
  request.about = "0,1,1";
  CHECK_THAT(refusal(planar(), request), Contains("a planar scene rotates about [0,0,1]"));
  request.about.reset();
  // held twice: no joint to the ground alone
  const std::string fixed = "type: fixed";
  CHECK_THAT(refusal(planar(fixed), request), Contains("expected --through X,Y"));
  CHECK_THAT(refusal(spatial(fixed), request), Contains("the axis is not that of one driven or revolute joint"));
}

// The derivative of bending in two planes twists the straight line and does not displace it: without it the strip under
// its load is 8 % off at rest already.
TEST_CASE("campbell: a strip that its load bends and twists, reduced") {
  const std::string strip = R"yaml(
bodies:
  strip:
    mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: 12}}
    section: {shape: rectangle, width: 0.008, height: 0.04, orientation: [0, 1, 0]}
    material: {E: 5e9, nu: 0.3, rho: 1200}
    reduction: {modes: 4, attachment: all}
joints: {root: {type: driven, between: [ground, strip.start], axis: [0, 0, 1], speed: 1}}
loads: {tip: {type: force, at: strip.end, axes: body, force: [0, 0, -28]}}
)yaml";
  const CampbellDiagram reduced = diagram(strip, Formulation::vm_md, at("5", 3)),
                        full = diagram(strip, Formulation::nlffr, at("5", 3));
  CHECK(diagram(strip, Formulation::vm_md, at("5", 3, true)).estimate.full_order);
  for (std::size_t i = 0; i < 3; ++i)
    CHECK(reduced.points.at(0).vibrations.at(i).omega ==
          Approx(full.points.at(0).vibrations.at(i).omega).epsilon(1e-4));
}

// Nothing holds it: five rigid motions beside the rotation have no stiffness at rest, one while it rotates. In rotating
// axes a body that translates, or whose axis of greatest inertia precesses, moves with the speed W.
TEST_CASE("campbell: a free plate, of more unknowns than are solved by a dense factor") {
  const bool oblique = GENERATE(false, true);
  const std::string plate =
      std::string(R"yaml(
bodies:
  p:
    mesh: {plate: {)yaml") +
      (oblique ? "origin: [-0.4, -0.5, 0.3], along: [0.8, 0, -0.6]" : "origin: [-0.5, -0.5, 0], along: [1, 0, 0]") +
      R"yaml(, across: [0, 1, 0], elements: [8, 8], cells: quadrilaterals}}
    section: {thickness: 0.01}
    material: {E: 7e10, nu: 0.3, rho: 2700}
joints: {}
)yaml";
  CampbellRequest request = at("0,5", 8);
  request.about = oblique ? "3,0,4" : "0,0,1", request.through = "0,0,0";
  const CampbellDiagram full = diagram(plate, Formulation::nlffr, request),
                        reduced = diagram(plate, Formulation::vm_md, request);
  for (const CampbellDiagram* one : {&full, &reduced}) {
    for (const CampbellPoint& point : one->points) REQUIRE(point.fault == "");
    for (const std::string& warning : one->model.warnings) CHECK_THAT(warning, !Contains("branch"));
    const auto& vibrations = one->points[1].vibrations;
    for (std::size_t i = 2; i < 6; ++i) CHECK(vibrations.at(i).omega == Approx(5).epsilon(1e-3));
    CHECK(vibrations.at(6).omega == Approx(208.2).epsilon(1e-3));
  }
}

namespace {

// It hangs outwards at all speeds, and inwards there is an unstable equilibrium, too.
const std::string hinged_rod = R"yaml(
gravity: [0, 0, -9.81]
bodies:
  hub:
    rigid: true
    mesh: {line: {from: [0, 0, 0], to: [0.05, 0, 0], elements: 1}}
    section: {shape: rectangle, width: 0.02, height: 0.02, orientation: [0, 1, 0]}
    material: {E: 7e10, nu: 0.3, rho: 2700}
  rod:
    mesh: {line: {from: [0, 0, 0], to: [0.75, 0, 0], elements: 8}}
    section: {shape: rectangle, width: 0.02, height: 0.002, orientation: [0, 0, 1]}
    material: {E: 7e10, nu: 0.3, rho: 2700}
    initial: {rotation: [0, 1.4, 0], position: [0.05, 0, 0]}
joints:
  drive: {type: driven, between: [ground, hub.start], axis: [0, 0, 1], angle: "t"}
  hinge: {type: revolute, between: [hub.end, rod.start], axis: [0, 1, 0]}
)yaml";

}  // namespace

// A second beam like the first, from a file: there is no full-order model.
TEST_CASE("campbell: beside bodies from files frequencies are compared with a second reduced model") {
  const floe::testing::Folder folder;
  const std::string path = (folder.path / "beam.h5").string();
  std::vector<std::string> warnings;
  assembly::reduce_body(scene::parse_scene(planar(), "scene"), "beam", PETSC_COMM_WORLD, path, true, warnings);
  std::string text = planar();
  text.insert(text.find("joints:"), "  other: {reduced: " + path + ", initial: {angle: pi}}\n");
  text.replace(text.rfind("}\n"), 2, ", weld: {type: fixed, between: [beam.start, other.start]}}\n");
  const CampbellDiagram found = diagram(text, Formulation::vm_md, at("0,2", 2, true));
  CHECK(found.estimate.missing == "");
  CHECK_FALSE(found.estimate.full_order);
  CHECK(found.estimate.coordinates > found.model.coordinates);
  REQUIRE(found.estimate.errors.size() == 2);
  for (const FrequencyError& one : found.estimate.errors) CHECK(one.relative < 1e-3);
  for (const std::string& warning : found.model.warnings) CHECK(warning.find("full-order") == std::string::npos);
}

TEST_CASE("campbell: estimate and comparison with cfr follow the branch of the diagram") {
  const CampbellDiagram found = diagram(hinged_rod, Formulation::vm_md, at("1,5,9", 3, true));
  REQUIRE(found.estimate.errors.size() == 3);
  for (const FrequencyError& one : found.estimate.errors) CHECK(one.relative < 1e-4);
  for (const std::string& one : found.model.warnings) CHECK_THAT(one, !Contains("cfr"));
}

// From an initial shape that is no equilibrium Newton's method came to the unstable one at 7 and at 9 rad/s.
TEST_CASE("campbell: the first speed is approached from rest where the initial shape is far from a steady rotation") {
  for (const double speed : {7., 9.}) {
    const CampbellDiagram found = diagram(hinged_rod, Formulation::vm_md, at(fmt::format("{}", speed), 2)),
                          followed = diagram(hinged_rod, Formulation::vm_md, at(fmt::format("1,3,5,{}", speed), 2));
    REQUIRE(found.points[0].vibrations.size() == 2);
    for (int i = 0; i < 2; ++i) {
      const auto &one = found.points[0].vibrations[i], &other = followed.points[3].vibrations[i];
      CHECK(one.growth == 0);
      CHECK(one.omega == Approx(other.omega).epsilon(1e-6));
    }
    const auto warned = [](const CampbellDiagram& by) {
      return std::any_of(by.model.warnings.begin(), by.model.warnings.end(), [](const std::string& text) {
        return text.find("the initial shape is not steady") != std::string::npos;
      });
    };
    CHECK(found.points[0].search.other > 1);
    CHECK(warned(found));
    CHECK_FALSE(warned(followed));
  }
}

TEST_CASE("campbell: an instability of a poor reduced model is checked with the full-order model") {
  // one mode without derivatives does not stiffen: omega^2 = 3.516^2 - Omega^2 about z in the plane, below 0 at 5
  const CampbellDiagram linear = diagram(planar(), Formulation::lffr, at("3,5", 1));
  CHECK(linear.points[0].vibrations.at(0).omega == Approx(std::sqrt(flap[0] * flap[0] - 9)).epsilon(0.02));
  std::string text = planar("type: driven, angle: \"2*t\"", "{count: 2}, derivatives: none");
  const CampbellDiagram poor = diagram(text, Formulation::vm_md, at("3,5", 1));
  bool unstable = false;
  for (const auto& one : poor.points[1].vibrations) unstable = unstable || one.unstable();
  REQUIRE(unstable);
  std::string warnings;
  for (const std::string& one : poor.model.warnings) warnings += one + "\n";
  CHECK_THAT(warnings, Contains("the instability at 5 rad/s is an artefact of the reduced model"));
}

TEST_CASE("campbell: tables and summaries have remarks, tracks and what is missing") {
  const OwnFolder own;
  const auto folder = own.results("out");
  // a free pendulum about its pin: one rigid-body mode of frequency 0
  const scene::Scene scene = scene::parse_scene(planar("type: revolute"), "scene");
  CampbellRequest request = at("1,4", 2, true);
  const std::string said = printed([&] { campbell_one(scene, Formulation::vm_md, PETSC_COMM_WORLD, request, folder); });
  CHECK_THAT(said, Contains("rigid-body mode") &&
                       Contains("Reduction error of the frequencies at 4 rad/s, by the full-order model"));
  const auto summary = nlohmann::json::parse(contents(folder.summary()));
  CHECK(summary["status"] == "finished");
  CHECK(summary["estimate"]["rad_per_s"] == 4);
  bool zero = false;
  for (const auto& one : summary["speeds"][0]["vibrations"])
    if (one["zero"] == true) zero = one["below_rad_per_s"].get<double>() > 0;
  CHECK(zero);
  CHECK(summary["speeds"][1]["vibrations"][1].contains("assurance"));
}

TEST_CASE("campbell: vibrations are followed through a crossing by their shapes") {
  const auto vibration = [](double omega, int which) {
    TrackedVibration one;
    one.omega = omega;
    one.shape = Eigen::VectorXcd::Zero(2);
    one.shape[which] = 1;
    one.momentum = one.shape;
    return one;
  };
  CampbellTracks tracks;
  CampbellPoint first{1, {}, 0, {}}, second{2, {}, 0, {}}, none{3, {}, 0, {}}, third{4, {}, 0, {}};
  first.vibrations = {vibration(1, 0), vibration(2, 1)};
  second.vibrations = {vibration(1.8, 1), vibration(2.2, 0)};  // they have crossed
  third.vibrations = {vibration(1.7, 1)};
  tracks.follow(first), tracks.follow(second), tracks.follow(none), tracks.follow(third);
  CHECK((first.vibrations[0].track == 1 && first.vibrations[1].track == 2));
  CHECK((second.vibrations[0].track == 2 && second.vibrations[1].track == 1));
  CHECK(second.vibrations[0].assurance == Approx(1));
  CHECK(third.vibrations[0].track == 2);
}

TEST_CASE("campbell: drives that move beside the rotation are named, those to the ground are the rotation") {
  const auto warnings = [](const std::string& inner) {
    const CampbellDiagram found = diagram(
        "bodies:\n  a: {rigid: {mass: 1, centre: [0, 0], inertia: 1}}\n"
        "  b: {rigid: {mass: 1, centre: [1, 0], inertia: 1}}\njoints:\n"
        "  d: {type: driven, between: [ground, a.centre], angle: 3*t}\n"
        "  i: {type: driven, between: [{body: a, node: [0.5, 0]}, {body: b, node: [0.5, 0]}], angle: " +
            inner + "}\n",
        Formulation::vm_md, at("3", 2));
    std::string all;
    for (const std::string& warning : found.model.warnings) all += warning + "\n";
    return all;
  };
  CHECK_THAT(warnings("7*t"), Catch::Contains("joint i moves at 7 rad/s at t = 0") && !Catch::Contains("joint d"));
  CHECK_THAT(warnings("7*t^2"), !Catch::Contains("moves at"));
}

// A mass on a string of 0.3 m, its cone at cos t = g/(W^2 l); let go 0.15 rad from it, Newton's method finds another.
TEST_CASE("campbell: a steady rotation far from the shape that was given is reported") {
  const auto found = [](double beside) {
    const double cone = std::acos(9.81 / (100 * 0.3));
    return diagram(fmt::format("gravity: [0, 0, -9.81]\n"
                               "bodies:\n  a: {{rigid: {{mass: 1, centre: [0, 0, 0], inertia: [0.01, 0.01, 0.01]}}}}\n"
                               "  p: {{rigid: {{mass: 1, centre: [0, 0, -0.3], inertia: [1e-8, 1e-8, 1e-8]}}, "
                               "initial: {{rotation: [0, {}, 0]}}}}\njoints:\n"
                               "  d: {{type: driven, between: [ground, a.centre], axis: [0, 0, 1], speed: 10}}\n"
                               "  h: {{type: revolute, between: [a.centre, {{body: p, node: [0, 0, 0]}}], "
                               "axis: [0, 1, 0]}}\n",
                               -(cone + beside)),
                   Formulation::vm_md, at("10", 2));
  };
  const auto is_far = [](const CampbellDiagram& diagram) {
    return std::any_of(diagram.model.warnings.begin(), diagram.model.warnings.end(), [](const std::string& warning) {
      return warning.find("the steady rotation found is") != std::string::npos;
    });
  };
  const CampbellDiagram near = found(0.01), far = found(0.15);
  CHECK(near.points[0].vibrations.at(0).omega == Approx(10 * std::sqrt(1 - std::pow(9.81 / 30, 2))).epsilon(1e-4));
  CHECK_FALSE(is_far(near));
  REQUIRE(far.points[0].vibrations.at(0).unstable());
  CHECK(is_far(far));
}
