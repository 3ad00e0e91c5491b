#include <catch2/catch.hpp>

#include "estimated.h"
#include "floe/solve/start.h"
#include "paper_cantilever.h"

using namespace floe;
using namespace floe::test;

namespace {

History full_order() { return move(text_of({.end = "3"}), Formulation::nlffr); }

struct Errors {
  double v, u;
};

Errors errors(const History& full, Formulation formulation, const std::string& reduction) {
  const History reduced = move(text_of({.end = "3", .reduction = reduction}), formulation);
  return {relative_error(reduced, full, "tip.y"), relative_error(reduced, full, "tip.x")};
}

}  // namespace

// Relative L2 errors of the tip to t = 3 against the full model of the same mesh, with m bending modes and all their
// derivatives; the bounds are 1.5 times what an independent computation found (3.7 / 9.2 %, 0.76 / 0.95 %, 0.31 /
// 0.40 %). The third mode is axial: it stands in the basis besides, and has no part in the derivatives.
TEST_CASE("joint modes: modes of the clamped beam with all their derivatives converge in the pinned frame") {
  const History full = full_order();
  const struct {
    const char* reduction;
    double v, u;
  } table[] = {
      {"{modes: {count: 4, of: joints}, derivatives: [[1, 1], [1, 2], [2, 2], [1, 4], [2, 4], [4, 4]]}", .037, .092},
      {"{modes: {count: 5, of: joints}, derivatives: [[1, 1], [1, 2], [2, 2], [1, 4], [2, 4], [4, 4], [1, 5], [2, 5], "
       "[4, 5], [5, 5]]}",
       .0076, .0095},
      {"{modes: {count: 6, of: joints}, derivatives: [[1, 1], [1, 2], [2, 2], [1, 4], [2, 4], [4, 4], [1, 5], [2, 5], "
       "[4, 5], [5, 5], [1, 6], [2, 6], [4, 6], [5, 6], [6, 6]]}",
       .0031, .0040}};
  for (const auto& row : table) {
    INFO(row.reduction);
    const Errors found = errors(full, Formulation::vm_md, row.reduction);
    CHECK(found.v < 1.5 * row.v);
    CHECK(found.u < 1.5 * row.u);
  }
}

// `derivatives: all` counts the axial mode among the five, and its derivatives reach further still.
TEST_CASE("joint modes: the default agrees with the full-order model to a thousandth") {
  const History full = full_order();
  const Errors found = errors(full, Formulation::vm_md, "{modes: 5, derivatives: all}");
  CHECK(found.v < 1e-3);
  CHECK(found.u < 1e-3);
}

// A hinged mode has no curvature at the root, where the clamp needs its moment: independent computations gave 34 / 77 %
// for 17 modes and 28 / 58 % for 12 modes and 5 derivatives. A program that finds less here does something else.
TEST_CASE("joint modes: hinged modes of a clamped beam do not converge") {
  const History full = full_order();
  const Errors modes = errors(full, Formulation::vm, "{modes: {count: 12, of: frame, alone: 17}, attachment: none}");
  CHECK(modes.v == Approx(.34).epsilon(0.1));
  CHECK(modes.u == Approx(.77).epsilon(0.1));
  const Errors derivatives = errors(
      full, Formulation::vm_md,
      "{modes: {count: 12, of: frame}, derivatives: [[1, 1], [1, 2], [2, 2], [1, 3], [2, 3]], attachment: none}");
  CHECK(derivatives.v > .25);
  CHECK(derivatives.u > .5);
}

TEST_CASE("joint modes: a warning of modes that cannot represent the moment of the clamp") {
  const auto warnings = [](const std::string& reduction) {
    return assembly::build(scene::parse_scene(text_of({.reduction = reduction}), "scene"), Formulation::vm_md,
                           PETSC_COMM_WORLD)
        .warnings;
  };
  const auto bad = warnings("{modes: {count: 3, of: frame}, attachment: none}");
  REQUIRE(bad.size() == 1);
  CHECK(bad[0].find("beam") != std::string::npos);
  CHECK(bad[0].find("clamp") != std::string::npos);
  CHECK(warnings("{modes: {count: 3, of: joints}}").empty());
  CHECK(warnings("{modes: {count: 3, of: frame}, attachment: joints}").empty());
}

// In a frame that is clamped at a place nothing deforms there, so that a force or moment at this place has no static
// response: modes of a body that is free there had no root moment (23 % too stiff). Expected: P L^3 / (3 E I), and the
// same deflection whether or not a probe of the joint's moment keeps the body from sharing the hub's frame.
TEST_CASE("joint modes: fixed by a joint to another body where the frame is clamped") {
  const bool space = GENERATE(false, true), probed = GENERATE(false, true);
  const std::string joint = GENERATE("fixed", "driven");
  INFO((space ? "in space, " : "in the plane, ") << joint << (probed ? ", probed" : ""));
  const std::string z = space ? ", 0" : "";
  assembly::Model model = assembly::build(
      scene::parse_scene(
          fill(R"yaml(
bodies:
  hub: {rigid: {mass: 8, centre: [0, 0$z], inertia: $inertia}}
  beam:
    mesh: {line: {from: [0, 0$z], to: [1, 0$z], elements: 20}}
    $section
    frame: {type: clamped, at: start}
    reduction: {modes: 4, derivatives: all}
joints:
  shaft: {type: fixed, between: [ground, hub.centre]}
  root: {type: $joint, between: [hub.centre, beam.start]}
loads: {lift: {type: force, at: beam.end, force: [0, 1e-3$z]}}
probes:
  tip: {at: beam.end}
  $probe
)yaml",
               {{"z", z},
                {"inertia", space ? "[1, 1, 1]" : "1"},
                {"section", space ? "section: {A: 1e-2, Iy: 1e-5, Iz: 1e-5, J: 2e-5, orientation: [0, 0, 1]}\n"
                                    "    material: {E: 1e6, nu: 0.3, rho: 100}"
                                  : "section: {EA: 1e4, EI: 10, rhoA: 1}"},
                {"joint",
                 joint + (joint == "driven" ? ", angle: 0*t" + std::string(space ? ", axis: [0, 0, 1]" : "") : "")},
                {"probe", probed ? "moment: {joint: root, quantity: moment}" : ""}}),
          "scene"),
      Formulation::vm_md, PETSC_COMM_WORLD);
  solve::equilibrium(*model.system, 0, model.U, model.V);
  CHECK(assembly::probe_values(model, 0, model.U, model.V)[1] == Approx(1e-3 / 30).epsilon(space ? 6e-3 : 2e-3));
}

// What stops, locks or brakes a hinge of the ground acts along the motion that this leaves free: without a vector for
// it the moment at the root was in error by 28 to 158 %.
TEST_CASE("a stop, a lock and friction at a hinge of the ground are in the basis") {
  const std::string plane = R"yaml(
gravity: [0, -9.81]
bodies:
  a:
    mesh: {line: {from: [0, 0], to: [0.5, 0], elements: 16}}
    section: {A: 4e-5, I: 5.33e-11}
    material: {E: 7e10, rho: 2700}
    damping: {stiffness: 1e-4}
joints: {h: {type: revolute, between: [ground, a.start]$joint}}
motion: {end: 0.5, step: 5e-4}
$events
probes:
  tip: {at: a.end, quantity: position}
  M: {joint: h, quantity: moment}
  b: {at: a.middle, relative_to: a.start}
)yaml";
  const std::string space = R"yaml(
gravity: [0, 0, -9.81]
bodies:
  a:
    mesh: {line: {from: [0, 0, 0], to: [0.5, 0, 0], elements: 12}}
    section: {shape: rectangle, width: 0.01, height: 0.004, orientation: [0, 1, 0]}
    material: {E: 7e10, nu: 0.3, rho: 2700}
    damping: {stiffness: 1e-4}
joints: {h: {type: revolute, between: [ground, a.start], axis: [0, 1, 0]$joint}}
motion: {end: 0.5, step: 5e-4}
$events
probes:
  tip: {at: a.end, quantity: position}
  M: {joint: h, quantity: moment}
  b: {at: a.end, relative_to: a.start}
)yaml";
  struct Case {
    std::string joint, events;
  };
  const Case c = GENERATE(Case{", limits: {lower: -0.4, upper: 0.4, stiffness: 200, damping: 0.2, width: 0.02}", ""},
                          Case{"", "events: {L: {lock: h, at: 0.2}}"},
                          Case{", friction: {level: 0.05, viscosity: 0.01, speed: 0.5}", ""});
  for (const std::string& text : {plane, space}) {
    const std::string scene = fill(text, {{"joint", c.joint}, {"events", c.events}});
    INFO(scene);
    const History reduced = move(scene, Formulation::vm_md), full = move(scene, Formulation::nlffr);
    for (const char* probe : {"tip", "b", "M"}) CHECK(vector_error(reduced, full, probe) < 0.01);
  }
}
