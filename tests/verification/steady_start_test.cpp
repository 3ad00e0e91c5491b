#include <catch2/catch.hpp>

#include "space_twin.h"

using namespace floe;
using namespace floe::test;

namespace {

/// Greatest change of a column over the motion.
double change(const History& at, const std::string& column) {
  const auto [low, high] = std::minmax_element(at[column].begin(), at[column].end());
  return *high - *low;
}

}  // namespace

// In the rotating frame nothing moves: deflections and reactions in axes of the blade stay what they were. Started
// undeformed the same beam swings.
TEST_CASE("steady start: nothing swings in a motion that begins at a steady rotation") {
  const std::string plane = R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0.2, 0.1], to: [1.2, 0.1], elements: 8}}
    section: {EA: 2000, EI: 5, rhoA: 1}
    frame: $frame
    $initial
joints: {root: {$joint, between: [ground, beam.start]}}
motion: {end: 0.5, step: 2e-3, start: $start}
probes:
  tip: {at: beam.end, relative_to: beam.start, quantity: position}
  root: {joint: root, relative_to: beam.start}
)yaml",
                    space = R"yaml(
gravity: [0, 0, -9.81]
bodies:
  beam:
    mesh: {line: {from: [0.2, 0.1, 0], to: [1.2, 0.1, 0], elements: 6}}
    section: {shape: rectangle, width: 0.03, height: 0.01, orientation: [0, 1, 0]}
    material: {E: 1e10, nu: 0.3, rho: 2700}
    frame: {type: clamped, at: start}
    $initial
joints: {root: {$joint, between: [ground, beam.start], axis: [0, 0, 1]}}
motion: {end: 0.2, step: 2e-3, start: $start}
probes:
  tip: {at: beam.end, relative_to: beam.start, quantity: position}
  root: {joint: root, relative_to: beam.start}
)yaml";
  const auto run = [](const std::string& scene, bool driven, const std::string& start, const std::string& frame,
                      Formulation formulation) {
    const bool flat = scene.find("orientation") == std::string::npos;
    return move(fill(scene, {{"joint", driven ? "type: driven, angle: 5*t" : "type: revolute"},
                             {"initial", driven ? ""
                                         : flat ? "initial: {angular_velocity: 5}"
                                                : "initial: {angular_velocity: [0, 0, 5]}"},
                             {"start", start},
                             {"frame", frame}}),
                formulation);
  };
  for (const bool driven : {true, false})
    for (const Formulation formulation : {Formulation::vm_md, Formulation::nlffr}) {
      const History at = run(plane, driven, "steady_rotation", "clamped", formulation),
                    given = run(plane, driven, "given", "clamped", formulation);
      CHECK(at["tip.x"][0] - 1 > 0.004);  // stretched: about rho w^2 L^3 / (3 EA)
      CHECK(change(at, "tip.x") < 1e-9);
      CHECK(change(at, "tip.y") < 1e-9);
      CHECK(change(given, "tip.x") > 0.004);
      CHECK(change(at, "root.x") < 1e-6 * std::abs(at["root.x"][0]));
      CHECK(total(at.energy.back()) == Approx(total(at.energy.front())).epsilon(1e-9));
    }
  int ranks = 1;
  MPI_Comm_size(PETSC_COMM_WORLD, &ranks);
  for (const Formulation formulation : {Formulation::vm_md, Formulation::nlffr, Formulation::cfr}) {
    if (formulation == Formulation::cfr && ranks > 1) continue;
    const History at = run(space, true, "steady_rotation", "", formulation),
                  given = run(space, true, "given", "", formulation);
    CHECK(at["tip.z"][0] < -0.003);  // bent by its weight
    // Nodes that move on circles do so with an error of the step, of order (w h)^2.
    const double small = formulation == Formulation::cfr ? 1e-5 : 1e-8;
    for (const std::string column : {"tip.x", "tip.y", "tip.z"}) CHECK(change(at, column) < small);
    CHECK(change(given, "tip.z") > 0.003);
    CHECK(change(at, "root.z") < 1e-5 * std::abs(at["root.z"][0]));
  }
}

// More unknowns than are solved densely: a sparse factor finds the same. The scene of shells is bent by its weight and
// stretched; free to rotate, too, where the rotation about the axis is left as it is.
TEST_CASE("steady start: full-order shells begin steadily, driven and free") {
  const std::string scene = R"yaml(
gravity: [0, 0, -9.81]
bodies:
  hub: {rigid: {mass: 2, centre: [0, 0.2, 0], inertia: [0.1, 0.1, 0.1]}, $initial}
  panel:
    mesh: {plate: {origin: [0.2, 0.1, 0], along: [1, 0, 0], across: [0, 0.2, 0], elements: [16, 4]}}
    section: {thickness: 0.008}
    material: {E: 7e10, nu: 0.3, rho: 2700}
joints:
  shaft: {$joint, between: [ground, hub.centre], axis: [0, 0, 1]}
  root: {type: fixed, between: [{body: hub, node: [0.2, 0.2, 0]}, panel.left]}
motion: {end: 0.04, step: 2e-3, start: steady_rotation}
probes: {tip: {at: panel.p3, relative_to: hub.centre, quantity: position}}
)yaml";
  int ranks = 1;
  MPI_Comm_size(PETSC_COMM_WORLD, &ranks);
  double deflection[2] = {};
  for (const bool driven : {true, false})
    for (const Formulation formulation : {Formulation::nlffr, Formulation::cfr}) {
      if (formulation == Formulation::cfr && ranks > 1) continue;
      CAPTURE(driven, formulation);
      const History at =
          move(fill(scene, {{"joint", driven ? "type: driven, angle: 12*t" : "type: revolute"},
                            {"initial", driven ? "initial: {}" : "initial: {angular_velocity: [0, 0, 12]}"}}),
               formulation);
      // A free hub slows down by 1e-5 in these steps, an error of order h^2.
      const double small = formulation == Formulation::cfr ? 1e-5 : driven ? 1e-8 : 1e-7;
      for (const std::string column : {"tip.x", "tip.y", "tip.z"}) CHECK(change(at, column) < small);
      CHECK(at["tip.z"][0] < -1e-3);
      double& known = deflection[formulation == Formulation::cfr];
      // In nlffr the panel's own frame is another one where the hub is driven.
      if (!driven) CHECK(at["tip.z"][0] == Approx(known).epsilon(formulation == Formulation::cfr ? 1e-8 : 1e-3));
      known = at["tip.z"][0];
    }
  if (ranks == 1) CHECK(deflection[1] == Approx(deflection[0]).epsilon(0.01));
}
