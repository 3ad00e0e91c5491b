#include <catch2/catch.hpp>
#include <map>

#include "building.h"
#include "scene_motion.h"

using namespace floe;
using namespace floe::test;
using Catch::Matchers::Contains;

namespace {

std::map<std::string, double> last(const History& history) {
  std::map<std::string, double> all;
  for (const auto& [name, values] : history.columns) all[name] = values.back();
  return all;
}

/// A stiff plate of 1 x 0.5 x 0.02, 100 kg/m3, rotated by 90 degrees about z: its x is along the world's y. Its edge at
/// the origin is clamped.
std::string plate(const std::string& load, const std::string& more = "") {
  return fill(R"yaml(
bodies:
  plate:
    mesh: {plate: {along: [1, 0, 0], across: [0, 0.5, 0], elements: [4, 2], cells: quadrilaterals}}
    section: {thickness: 0.02}
    material: {E: 1e13, nu: 0.3, rho: 100}
    initial: {rotation: [0, 0, pi/2]}
    reduction: {modes: 3}
joints: {clamp: {type: fixed, between: [ground, plate.left]}}
$more
loads: {load: {$load}}
probes:
  f: {joint: clamp, quantity: force}
  m: {joint: clamp, quantity: moment}
)yaml",
              {{"more", more}, {"load", load}});
}

struct Expected {
  const char* load;
  double force[3], moment[3];  // resultants in world axes, about the middle of the clamped edge at (-0.25, 0, 0)
};

}  // namespace

TEST_CASE("loads on shells at rest: a clamped edge bears their resultants, in every formulation") {
  // the far edge's middle is at (-0.25, 1, 0), 1 m along y from the clamped one
  const Expected all[] = {
      {"type: force, at: plate.right, force: [1, 2, 3]", {1, 2, 3}, {3, 0, -1}},
      {"type: force, at: plate.right, force: [1, 2, 3], axes: body", {-2, 1, 3}, {3, 0, 2}},
      {"type: force, at: plate.right, force: [1, 2, 3], axes: place", {-2, 1, 3}, {3, 0, 2}},
      {"type: moment, at: plate.right, moment: [1, 2, 3]", {0, 0, 0}, {1, 2, 3}},
      {"type: moment, at: plate.right, moment: [1, 2, 3], axes: body", {0, 0, 0}, {-2, 1, 3}},
      {"type: force, at: {body: plate, node: [1, 0.5, 0]}, force: [0, 0, 4]", {0, 0, 4}, {4, 1, 0}},
      {"type: force, at: plate.right, per: length, force: [0, 0, 4]", {0, 0, 2}, {2, 0, 0}},
      {"type: moment, at: plate.right, per: length, moment: [0, 0, 4]", {0, 0, 0}, {0, 0, 2}},
      // odd across the edge: a couple of 2 int 4 (y'/0.25) y' dy', y' from its middle, 4/0.25 x 0.5^3/12
      {"type: force, at: plate.right, per: length, force: [0, 0, 4], shape: \"(y - 0.25)/0.25\"",
       {0, 0, 0},
       {0, 4 / 0.25 * 0.125 / 12, 0}},
      {"type: pressure, body: plate, pressure: 6", {0, 0, 3}, {1.5, 0, 0}},
      {"type: pressure, body: plate, pressure: 6, follower: false", {0, 0, 3}, {1.5, 0, 0}}};
  for (const Expected& one : all)
    for (const auto formulation : {Formulation::nlffr, Formulation::lffr, Formulation::vm_md, Formulation::cfr}) {
      INFO(one.load << " " << scene::name_of(formulation));
      auto at = last(rest(plate(one.load), formulation));
      for (int i = 0; i < 3; ++i) {
        const std::string axis(1, "xyz"[i]);
        CHECK(at["f." + axis] == Approx(-one.force[i]).margin(1e-4));
        CHECK(at["m." + axis] == Approx(-one.moment[i]).margin(1e-4));
      }
    }
}

TEST_CASE("weight and the ground's acceleration in space: the mass times the difference, at the centre") {
  for (const auto formulation : {Formulation::nlffr, Formulation::vm_md, Formulation::cfr}) {
    INFO(scene::name_of(formulation));
    // 1 kg, its centre 0.5 m along y
    auto at = last(rest(plate("type: force, at: plate.right, force: [0, 0, 0]", "gravity: [0, 1, -10]"), formulation));
    CHECK(at["f.y"] == Approx(-1).epsilon(1e-6));
    CHECK(at["f.z"] == Approx(10).epsilon(1e-6));
    CHECK(at["m.x"] == Approx(5).epsilon(1e-5));
    at = last(rest(plate("type: force, at: plate.right, force: [0, 0, 0]",
                         "gravity: [0, 0, \"-10*t\"]\nground: {acceleration: [0, 0, \"2*t\"]}"),
                   formulation));
    CHECK(at["f.z"] == Approx(12).epsilon(1e-6));
  }
}

TEST_CASE("loads on beams at rest, in space and in the plane: forces, moments and line loads by axes and formulation") {
  const std::string space = R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0, 0], to: [2, 0, 0], elements: 4}}
    section: {A: 1, Iy: 1, Iz: 1, J: 2, orientation: [0, 1, 0]}
    material: {E: 1e9, G: 4e8, rho: 1}
    initial: {rotation: [0, 0, pi/2]}
    reduction: {modes: 3}
joints: {clamp: {type: fixed, between: [ground, beam.start]}}
loads: {load: {$load}}
probes:
  f: {joint: clamp, quantity: force}
  m: {joint: clamp, quantity: moment}
)yaml";
  const std::string flat = R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [2, 0], elements: 4}}
    section: {EA: 1e9, EI: 1e9, rhoA: 1}
    initial: {angle: pi/2}
    reduction: {modes: 3}
joints: {clamp: {type: fixed, between: [ground, beam.start]}}
loads: {load: {$load}}
probes:
  f: {joint: clamp, quantity: force}
  m: {joint: clamp, quantity: moment}
)yaml";
  const Expected in_space[] = {
      {"type: distributed, body: beam, force: [1, 2, 3]", {2, 4, 6}, {6, 0, -2}},
      {"type: distributed, body: beam, force: [1, 2, 3], axes: body", {-4, 2, 6}, {6, 0, 4}},
      {"type: force, at: beam.middle, force: [1, 2, 3], axes: body", {-2, 1, 3}, {3, 0, 2}},
      {"type: force, at: beam.end, force: [1, \"2*t\", 3], axes: place", {-2, 1, 3}, {6, 0, 4}}};
  const Expected in_plane[] = {{"type: distributed, body: beam, force: [1, 2]", {2, 4}, {-2}},
                               {"type: distributed, body: beam, force: [1, 2], axes: body", {-4, 2}, {4}},
                               {"type: force, at: beam.middle, force: [1, 2], axes: body", {-2, 1}, {2}},
                               {"type: force, at: beam.end, force: [1, \"2*t\"], axes: place", {-2, 1}, {4}},
                               {"type: moment, at: beam.end, moment: 3", {0, 0}, {3}}};
  for (const auto formulation : testing::all_formulations()) {
    for (const Expected& one : in_space) {
      INFO(one.load << " " << scene::name_of(formulation));
      auto at = last(rest(fill(space, {{"load", one.load}}), formulation));
      for (int i = 0; i < 3; ++i) {
        CHECK(at["f." + std::string(1, "xyz"[i])] == Approx(-one.force[i]).margin(1e-5));
        CHECK(at["m." + std::string(1, "xyz"[i])] == Approx(-one.moment[i]).margin(1e-5));
      }
    }
    for (const Expected& one : in_plane) {
      INFO(one.load << " " << scene::name_of(formulation));
      auto at = last(rest(fill(flat, {{"load", one.load}}), formulation));
      CHECK(at["f.x"] == Approx(-one.force[0]).margin(1e-5));
      CHECK(at["f.y"] == Approx(-one.force[1]).margin(1e-5));
      CHECK(at["m.z"] == Approx(-one.moment[0]).margin(1e-5));
    }
  }
}

TEST_CASE(
    "loads of sensors: a force that depends on its place finds the equilibrium of a spring, in every formulation") {
  // (10 - 40 u) at a tip of stiffness 3 EI/L^3 = 60
  const std::string flat = R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 4}}
    section: {EA: 1e6, EI: 20, rhoA: 1}
    frame: {type: clamped, at: start}
    reduction: {modes: 2, attachment: all}
joints: {clamp: {type: fixed, between: [ground, beam.start]}}
loads: {pull: {type: force, at: beam.end, force: [0, "0.1 - 40*u.y"]}}
probes:
  u: {at: beam.end, quantity: displacement}
  e: {formula: "2*u.y", unit: m}
)yaml";
  const std::string space = R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: 4}}
    section: {A: 1, Iy: 2e-5, Iz: 2e-5, J: 4e-5, orientation: [0, 1, 0]}
    material: {E: 1e6, G: 4e5, rho: 1}
    reduction: {modes: 2, attachment: all}
joints: {clamp: {type: fixed, between: [ground, beam.start]}}
loads: {pull: {type: force, at: beam.end, force: [0, "0.1 - 40*u.y", 0]}}
probes:
  u: {at: beam.end, quantity: displacement}
  e: {formula: "2*u.y", unit: m}
)yaml";
  for (const auto formulation : testing::all_formulations())
    for (const std::string& text : {flat, space}) {
      INFO(scene::name_of(formulation) << (text == flat ? ", plane" : ", space"));
      auto at = last(rest(text, formulation));
      CHECK(at["u.y"] == Approx(0.1 / (40 + 60)).epsilon(1e-3));
      CHECK(at["e.value"] == Approx(2 * at["u.y"]));
    }
}

TEST_CASE("loads of joints: a torque that holds an angle, in the plane and in space") {
  // weight 2 kg, 10 m/s2 at 0.5 m: 10 cos(a) against 100 a
  const std::string loads =
      "loads: {motor: {type: moment, joint: hinge, moment: \"-100*hinge.angle - 3*hinge.rate\"}}\n"
      "probes:\n  a: {joint: hinge, quantity: angle}\n  m: {joint: hinge, quantity: moment}\n"
      "  d: {joint: hinge, quantity: drive}\n";
  const std::string flat =
      "bodies: {arm: {rigid: {mass: 2, centre: [0.5, 0], inertia: 1}}}\ngravity: [0, -10]\n"
      "joints: {hinge: {type: revolute, between: [ground, {body: arm, node: [0, 0]}]}}\n" +
      loads;
  const std::string space =
      "bodies: {arm: {rigid: {mass: 2, centre: [0.5, 0, 0], inertia: [1, 1, 1]}}}\ngravity: [0, -10, 0]\n"
      "joints: {hinge: {type: revolute, axis: [0, 0, 1], between: [ground, {body: arm, node: [0, 0, 0]}]}}\n" +
      loads;
  double angle = 0;
  for (int i = 0; i < 50; ++i) angle = -0.1 * std::cos(angle);
  for (const auto formulation : {Formulation::vm_md, Formulation::nlffr, Formulation::cfr})
    for (const std::string& text : {flat, space}) {
      auto at = last(rest(text, formulation));
      CHECK(at["a.value"] == Approx(angle).epsilon(1e-8));
      CHECK(at["m.z"] == Approx(-100 * angle).epsilon(1e-7));
      CHECK(at["d.value"] == Approx(-100 * angle).epsilon(1e-7));
    }
}

TEST_CASE("what a torsional spring exerts as a drive is its moment, in the plane and in space") {
  const std::string text = R"yaml(
bodies: {arm: {rigid: {mass: 2, centre: [0.5, 0$zero], inertia: $inertia}}}
gravity: [0, -10$zero]
joints:
  hinge: {type: revolute, between: [ground, {body: arm, node: [0, 0$zero]}]$axis}
  spring: {type: spring, between: [ground, {body: arm, node: [0, 0$zero]}], torsional_stiffness: 100$axis}
probes:
  a: {joint: hinge, quantity: angle}
  d: {joint: spring, quantity: drive}
)yaml";
  for (const std::string& scene :
       {fill(text, {{"zero", ""}, {"inertia", "1"}, {"axis", ""}}),
        fill(text, {{"zero", ", 0"}, {"inertia", "[1, 1, 1]"}, {"axis", ", axis: [0, 0, 1]"}})}) {
    auto at = last(rest(scene, Formulation::vm_md));
    CHECK(std::abs(at["a.value"]) > 0.09);
    CHECK(at["d.value"] == Approx(-100 * at["a.value"]).epsilon(1e-7));
  }
}
