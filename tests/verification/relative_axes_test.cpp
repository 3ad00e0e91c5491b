#include <catch2/catch.hpp>

#include "space_twin.h"

// `relative_to` in the plane: components in axes that rotate with a place from those of the mesh, as in space. All
// lines are oblique, so that the axes of the floating frames differ from these.

using namespace floe;
using namespace floe::test;

namespace {

/// An arm with a rigid rod at its end, on which acts a force by a probe that is relative to the arm's end.
std::string mechanism(bool space, const std::string& frame, const std::string& rest = "") {
  const std::string axis = space ? ", axis: [0, 0, 1]" : "", nothing = space ? ", 0" : "",
                    section = space ? "{shape: rectangle, width: 0.05, height: 0.01, orientation: [0, 0, 1]}"
                                    : "{A: 5e-4, I: 4.1666666666666667e-9}";
  return fill(R"yaml(
bodies:
  arm:
    mesh: {line: {from: [0, 0$0], to: [0.6, 0.8$0], elements: 6}}
    section: $section
    material: {E: 7e10$nu, rho: 2700}
    frame: $frame
    reduction: {modes: 4}
  rod:
    rigid: true
    mesh: {line: {from: [0.6, 0.8$0], to: [1, 0.5$0], elements: 2}}
    section: $section
    material: {E: 7e10$nu, rho: 2700}
joints:
  root: {type: revolute, between: [ground, arm.start]$axis}
  elbow: {type: revolute, between: [arm.end, rod.start]$axis}
loads:
  push: {type: force, at: rod.end, force: ["3000*t^2*seen.x", "100*t*moved.y"$0]}
motion: {end: 0.1, step: 1e-3}
probes:
  seen: {at: rod.end, quantity: position, relative_to: arm.end}
  moved: {at: rod.end, quantity: displacement, relative_to: arm.start}
  back: {at: arm.end, quantity: position, relative_to: rod.end}
  speed: {at: rod.end, quantity: velocity, relative_to: arm.end}
  felt: {at: rod.end, quantity: acceleration, relative_to: rod.end}
  tip: {at: arm.end, quantity: acceleration, relative_to: arm.end}
  reaction: {joint: root, relative_to: arm.start}
  inside: {joint: elbow, relative_to: rod.start}
)yaml",
              {{"section", section},
               {"frame", frame},
               {"axis", axis},
               {"0", nothing},
               {"nu", space ? ", nu: 0.3" : ""}}) +
         rest;
}

/// The components that an oblique strut's reaction to a unit force has in the axes of its start.
Eigen::Vector2d reaction_of_strut(const std::string& body, Formulation formulation) {
  const assembly::Model model = assembly::build(scene::parse_scene(body + R"yaml(
joints: {g: {type: fixed, between: [ground, b.start]}}
loads: {f: {type: force, at: b.end, force: [1, 0]}}
motion: {end: 1, step: 0.1}
probes: {F: {joint: g, quantity: force, relative_to: b.start}}
)yaml",
                                                                   "scene"),
                                                formulation, PETSC_COMM_WORLD);
  solve::equilibrium(*model.system, 0, model.U, model.V);
  const std::vector<double> values = assembly::probe_values(model, 0, model.U, model.V);
  return {values[0], values[1]};
}

}  // namespace

TEST_CASE("relative axes: an oblique strut's reaction has the components of the mesh axes") {
  const auto strut = [](const std::string& with) {
    return "bodies:\n  b:\n    mesh: {line: {from: [0, 0], to: [0.6, 0.8], elements: 4}}\n"
           "    section: {A: 6e-4, I: 4.5e-8}\n    material: {E: 7e9, rho: 2700}\n" +
           with;
  };
  for (const char* frame : {"pinned", "clamped", "mean-axis"})
    for (const Formulation formulation :
         {Formulation::vm, Formulation::vm_md, Formulation::lffr, Formulation::nlffr, Formulation::cfr}) {
      INFO(frame << ", " << scene::name_of(formulation));
      const Eigen::Vector2d F = reaction_of_strut(strut("    frame: " + std::string(frame) + "\n"), formulation);
      CHECK((F - Eigen::Vector2d(-1, 0)).norm() < 1e-4);
    }
  CHECK((reaction_of_strut(strut("    rigid: true\n"), Formulation::vm) - Eigen::Vector2d(-1, 0)).norm() < 1e-9);
}

TEST_CASE("relative axes: probes and sensors of oblique bodies in the plane are those in space") {
  for (const char* frame : {"pinned", "clamped", "mean-axis"})
    for (const Formulation formulation : {Formulation::vm_md, Formulation::nlffr, Formulation::cfr}) {
      INFO(frame << ", " << scene::name_of(formulation));
      const History plane = move(mechanism(false, frame), formulation),
                    space = move(mechanism(true, frame), formulation);
      for (const char* probe : {"seen", "moved", "back", "speed", "felt", "tip", "reaction", "inside"}) {
        INFO(probe);
        CHECK(apart(space, Eigen::Matrix3d::Identity(), plane, probe) < 0.02);
      }
    }
}

TEST_CASE("relative axes: an event of a probe in the axes of an oblique body") {
  const std::string event = "events: {drop: {unlock: elbow, probe: moved.y, crosses: 0.01}}\n";
  for (const Formulation formulation : {Formulation::vm_md, Formulation::cfr}) {
    INFO(scene::name_of(formulation));
    const History plane = move(mechanism(false, "pinned", event), formulation),
                  space = move(mechanism(true, "pinned", event), formulation);
    REQUIRE(plane.events.size() == 1);
    REQUIRE(space.events.size() == 1);
    CHECK(plane.events[0].t == Approx(space.events[0].t).epsilon(0.01));
  }
}
