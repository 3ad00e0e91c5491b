#include <catch2/catch.hpp>
#include <map>

#include "building.h"
#include "floe/solve/start.h"
#include "scene_motion.h"

using namespace floe;
using namespace floe::test;

namespace {

/// A rigid body of 2 kg with moments of inertia 3, 4, 5 about its centre, which a joint connects to the ground, under a
/// force (6, 8, 10) at its centre and a moment (12, 20, 30).
std::string scene_with(const std::string& joint, const std::string& probes = "") {
  return fill(R"yaml(
bodies: {block: {rigid: {mass: 2, centre: [0, 0, 0], inertia: [3, 4, 5]}, initial: {position: [1, 2, 3]}}}
joints: {j: {between: [$ground, block.centre], $joint}}
loads:
  push: {type: force, at: block.centre, force: [6, 8, 10]}
  twist: {type: moment, at: block.centre, moment: [12, 20, 30]}
motion: {end: 0.02, step: 0.01}
probes:
  a: {at: block.centre, quantity: acceleration}
  w: {at: block.centre, quantity: angular_acceleration}
$probes)yaml",
              {{"ground", joint.find("distance") != std::string::npos || joint.find("spring") != std::string::npos
                              ? "{body: ground, node: [1, 2, 1]}"
                              : "ground"},
               {"joint", joint},
               {"probes", probes}});
}

/// With the accelerations and reactions of the start.
std::map<std::string, double> at_start(const assembly::Model& model) {
  std::map<std::string, double> all;
  const auto columns = assembly::probe_columns(model);
  const petsc::VecHandle A = model.system->create_vector();
  solve::consistent_start(*model.system, 0, model.U, model.V, A);
  const std::vector<double> values = assembly::probe_values(model, 0, model.U, model.V, A);
  for (std::size_t i = 0; i < columns.size(); ++i) all[columns[i].name] = values[i];
  return all;
}

struct Case {
  const char* joint;
  int rows;
  double translation[3], rotation[3];  // accelerations at the start
};

constexpr double free_a[3] = {3, 4, 5}, free_w[3] = {4, 5, 6};

}  // namespace

TEST_CASE("joints in space leave a body the accelerations of their free directions and react in the others") {
  const Case cases[] = {
      {"type: fixed", 6, {0, 0, 0}, {0, 0, 0}},
      {"type: revolute, axis: [0, 0, 1]", 5, {0, 0, 0}, {0, 0, free_w[2]}},
      {"type: revolute, axis: [0, -2, 0]", 5, {0, 0, 0}, {0, free_w[1], 0}},
      {"type: prismatic, axis: [1, 0, 0]", 5, {free_a[0], 0, 0}, {0, 0, 0}},
      {"type: cylindrical, axis: [0, 0, 1]", 4, {0, 0, free_a[2]}, {0, 0, free_w[2]}},
      {"type: universal, axis: [0, 0, 1], second_axis: [1, 0, 0]", 4, {0, 0, 0}, {free_w[0], 0, free_w[2]}},
      {"type: spherical", 3, {0, 0, 0}, {free_w[0], free_w[1], free_w[2]}},
      {"type: planar, axis: [0, 1, 0]", 3, {free_a[0], 0, free_a[2]}, {0, free_w[1], 0}},
      {"type: distance", 1, {free_a[0], free_a[1], 0}, {free_w[0], free_w[1], free_w[2]}},
      {"type: driven, axis: [0, 0, 1], angle: \"t^2\"", 6, {0, 0, 0}, {0, 0, 2}},
      {"type: driven_slide, axis: [0, 1, 0], position: \"-2*t^2\"", 6, {0, -4, 0}, {0, 0, 0}},
      {"type: driven_slide, axis: [0, 1, 0], speed: \"3*t\"", 6, {0, 3, 0}, {0, 0, 0}},
      {"type: bushing, translation: [1, 1, 1], rotation: [1, 1, 1]", 0, {3, 4, 5}, {4, 5, 6}},
      // 2 m apart along z, 1.5 m relaxed: 0.5 m of 8 N/m back
      {"type: spring, stiffness: 8, length: 1.5", 0, {3, 4, 5 - 2}, {4, 5, 6}},
      {"type: spring, stiffness: 8, preload: 6", 0, {3, 4, 5 - 3}, {4, 5, 6}},
      {"type: spring, torsional_stiffness: 10, rest_angle: 0.5, axis: [0, 0, 1]", 0, {3, 4, 5}, {4, 5, 6 + 1}}};
  for (const Case& one : cases)
    for (const auto formulation : {Formulation::vm_md, Formulation::nlffr, Formulation::cfr}) {
      INFO(one.joint << " " << scene::name_of(formulation));
      const assembly::Model model = testing::built(
          scene_with(one.joint, "  f: {joint: j, quantity: force}\n  m: {joint: j, quantity: moment}\n"), formulation);
      CHECK(model.multipliers == one.rows);
      auto at = at_start(model);
      const char axes[] = "xyz";
      const double mass = 2, inertia[3] = {3, 4, 5}, force[3] = {6, 8, 10}, moment[3] = {12, 20, 30};
      for (int i = 0; i < 3; ++i) {
        const std::string axis(1, axes[i]);
        CHECK(at.at("a." + axis) == Approx(one.translation[i]).margin(1e-9));
        CHECK(at.at("w." + axis) == Approx(one.rotation[i]).margin(1e-9));
        CHECK(at.at("f." + axis) == Approx(mass * one.translation[i] - force[i]).margin(1e-8));
        CHECK(at.at("m." + axis) == Approx(inertia[i] * one.rotation[i] - moment[i]).margin(1e-8));
      }
    }
}

TEST_CASE("joints whose places are apart, or that have no line, are refused with where they are") {
  const auto said = [](const std::string& joint) {
    return testing::complaint(fill("bodies: {b: {rigid: {mass: 2, centre: [0, 0, 0], inertia: [3, 4, 5]}}}\n"
                                   "joints: {j: {$joint}}\nmotion: {end: 1, step: 0.1}\n",
                                   {{"joint", joint}}),
                              Formulation::vm_md);
  };
  using Catch::Matchers::Contains;
  CHECK_THAT(said("type: spherical, between: [{body: ground, node: [0, 0, 1]}, b.centre]"),
             Contains("its places are 1 apart at the start: (0, 0, 1) and (0, 0, 0)"));
  CHECK_THAT(said("type: distance, between: [ground, b.centre]"), Contains("its places coincide; expected a distance"));
  CHECK_THAT(said("type: spring, stiffness: 1, length: 1, between: [ground, b.centre]"),
             Contains("the places of spring j coincide at the start"));
  CHECK(said("type: spring, stiffness: 1, length: 0, between: [ground, b.centre]").empty());
  CHECK(said("type: prismatic, axis: [0, 0, 1], between: [{body: ground, node: [0, 0, 1]}, b.centre]").empty());
}

TEST_CASE("friction and stops of joints in space act on their coordinate alone") {
  // 2 kg at 0.5 m/s along x against 4 N and 2 N s/m; 5 kg m2 at 2 rad/s about x is beyond its stop by 0.1 rad
  const auto start = [](const std::string& joint, const std::string& rates) {
    return at_start(testing::built(fill(R"yaml(
bodies:
  b:
    rigid: {mass: 2, centre: [0, 0, 0], inertia: [5, 4, 3]}
    initial: {$rates}
joints: {j: {between: [ground, b.centre], axis: [1, 0, 0], $joint}}
motion: {end: 0.02, step: 0.01}
probes:
  a: {at: b.centre, quantity: acceleration}
  w: {at: b.centre, quantity: angular_acceleration}
)yaml",
                                        {{"joint", joint}, {"rates", rates}}),
                                   Formulation::vm_md));
  };
  auto at = start("type: prismatic, friction: {level: 4, speed: 1e-3, viscosity: 2}", "velocity: [0.5, 0, 0]");
  CHECK(at.at("a.x") == Approx(-(4 + 2 * 0.5) / 2).epsilon(1e-9));
  at = start(
      "type: cylindrical, friction: {level: 4, speed: 1e-3}, turn_friction: {level: 10, speed: 1e-3, viscosity: 1}",
      "velocity: [0.5, 0, 0], angular_velocity: [-2, 0, 0]");
  CHECK(at.at("a.x") == Approx(-4 / 2.).epsilon(1e-9));
  CHECK(at.at("w.x") == Approx((10 + 2) / 5.).epsilon(1e-9));
  at = start("type: revolute, limits: {upper: -0.1, stiffness: 50, width: 1e-6}", "angular_velocity: [0, 0, 0]");
  CHECK(at.at("w.x") == Approx(-50 * 0.1 / 5).epsilon(1e-4));
  at = start(
      "type: cylindrical, limits: {lower: 0.2, stiffness: 30, width: 1e-6}, turn_limits: {lower: 0.1, stiffness: 50, "
      "width: 1e-6}",
      "velocity: [0, 0, 0]");
  CHECK(at.at("a.x") == Approx(30 * 0.2 / 2).epsilon(1e-4));
  CHECK(at.at("w.x") == Approx(50 * 0.1 / 5).epsilon(1e-4));
}

TEST_CASE("joints in the plane leave a body the accelerations of their free directions and react in the others") {
  const struct {
    const char* joint;
    int rows;
    double x, y, w;
  } cases[] = {{"type: fixed", 3, 0, 0, 0},
               {"type: revolute", 2, 0, 0, 6},
               {"type: prismatic, axis: [0, 2]", 2, 0, 4, 0},
               {"type: driven, angle: \"-t^2\"", 3, 0, 0, -2},
               {"type: driven, speed: \"3*t\"", 3, 0, 0, 3},
               {"type: spring, torsional_stiffness: 10, rest_angle: 0.5", 0, 3, 4, 7}};
  for (const auto& one : cases)
    for (const auto formulation : testing::all_formulations()) {
      INFO(one.joint << " " << scene::name_of(formulation));
      const assembly::Model model = testing::built(fill(R"yaml(
bodies: {block: {rigid: {mass: 2, centre: [0, 0], inertia: 5}, initial: {position: [1, 2], angle: 0.3}}}
joints: {j: {between: [ground, block.centre], $joint}}
loads:
  push: {type: force, at: block.centre, force: [6, 8]}
  twist: {type: moment, at: block.centre, moment: 30}
motion: {end: 0.02, step: 0.01}
probes:
  a: {at: block.centre, quantity: acceleration}
  w: {at: block.centre, quantity: angular_acceleration}
  f: {joint: j, quantity: force}
  m: {joint: j, quantity: moment}
)yaml",
                                                        {{"joint", one.joint}}),
                                                   formulation);
      CHECK(model.multipliers == one.rows);
      auto at = at_start(model);
      CHECK(at.at("a.x") == Approx(one.x).margin(1e-9));
      CHECK(at.at("a.y") == Approx(one.y).margin(1e-9));
      CHECK(at.at("w.z") == Approx(one.w).margin(1e-9));
      CHECK(at.at("f.x") == Approx(2 * one.x - 6).margin(1e-8));
      CHECK(at.at("f.y") == Approx(2 * one.y - 8).margin(1e-8));
      CHECK(at.at("m.z") == Approx(5 * one.w - 30).margin(1e-8));
    }
}
