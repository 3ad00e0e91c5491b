#include <catch2/catch.hpp>

#include "space_twin.h"

using namespace floe;
using namespace floe::test;

// m = 2, k = 50, w = 5: x - x0 = -(F / k) (1 - cos w t) from the tension F at the start.
TEST_CASE("preload: a mass on a spring that is tight at the start") {
  for (const bool space : {false, true}) {
    const History at = move(
        fill(R"yaml(
bodies:
  mass:
    rigid: true
    mesh: {line: {from: [-0.1, 0$z], to: [0.1, 0$z], elements: 2}}
    section: {$section}
    $material
    initial: {position: [1, 0$z]}
joints:
  guide: {type: prismatic, between: [ground, {body: mass, node: [0, 0$z]}], axis: [1, 0$z]}
  spring: {type: spring, between: [{body: ground, node: [0, 0$z]}, {body: mass, node: [0, 0$z]}], stiffness: 50, preload: 4}
motion: {end: 2, step: 2e-3}
probes: {mass: {at: {body: mass, node: [0, 0$z]}, quantity: position}, spring: {joint: spring}}
)yaml",
             {{"z", space ? ", 0" : ""},
              {"section", space ? "shape: rectangle, width: 0.1, height: 0.1, orientation: [0, 1, 0]" : "rhoA: 10"},
              {"material", space ? "material: {E: 1, nu: 0, rho: 1000}" : ""}}),
        Formulation::vm_md);
    CHECK(at["spring.x"][0] == Approx(-4).epsilon(1e-9));
    for (std::size_t i = 0; i < at.t.size(); ++i)
      CHECK(at["mass.x"][i] == Approx(1 - 0.08 * (1 - std::cos(5 * at.t[i]))).margin(2e-5));
  }
}

// J = 3 about the hinge, k = 48, w = 4: angle = rest (1 - cos w t).
TEST_CASE("preload: a hinged rod on a torsional spring that is relaxed at another angle") {
  for (const bool space : {false, true}) {
    const History at = move(fill(R"yaml(
bodies:
  rod:
    rigid: {mass: 1, centre: [0, 0$z], inertia: $J}
joints:
  hinge: {type: revolute, between: [ground, rod.centre]$axis}
  spring: {type: spring, between: [ground, rod.centre], torsional_stiffness: 48, rest_angle: $rest$axis}
motion: {end: 2, step: 1e-3}
probes: {turn: {formula: hinge.angle}}
)yaml",
                                 {{"z", space ? ", 0" : ""},
                                  {"J", space ? "[3, 3, 3]" : "3"},
                                  {"rest", "2"},
                                  {"axis", space ? ", axis: [0, 0, 1]" : ""}}),
                            Formulation::vm_md);
    for (std::size_t i = 0; i < at.t.size(); ++i)
      CHECK(at["turn.value"][i] == Approx(2 * (1 - std::cos(4 * at.t[i]))).margin(2e-4));
  }
}

// x.. + w^2 x = -a(t), a a triangle of the height A over 2 T: x = -(A / T) (r(t) - 2 r(t - T) + r(t - 2T)) with
// r(t) = (t - sin(w t) / w) / w^2 for t > 0.
TEST_CASE("base excitation: an oscillator under a record of the ground's acceleration") {
  const Scratch scratch;
  const std::string path = (scratch.path / "quake.csv").string();
  write_text(path, "t, a\n0, 0\n0.3, 6\n0.6, 0\n5, 0\n");
  const History at = move(fill(R"yaml(
functions: {quake: {file: $path}}
ground: {acceleration: [0, "quake(t)"]}
bodies:
  mass: {rigid: {mass: 2, centre: [0, 0], inertia: 1}, initial: {position: [0, 1]}}
joints:
  guide: {type: prismatic, between: [ground, mass.centre], axis: [0, 1]}
  spring: {type: spring, between: [{body: ground, node: [0, 0]}, mass.centre], stiffness: 50}
motion: {end: 2, step: 1e-3}
probes: {mass: {at: mass.centre, quantity: displacement}}
)yaml",
                               {{"path", path}}),
                          Formulation::vm_md);
  const double w = 5, A = 6, T = 0.3;
  const auto r = [&](double t) { return t > 0 ? (t - std::sin(w * t) / w) / (w * w) : 0; };
  double largest = 0;
  for (std::size_t i = 0; i < at.t.size(); ++i) {
    const double t = at.t[i], x = -(A / T) * (r(t) - 2 * r(t - T) + r(t - 2 * T));
    CHECK(at["mass.y"][i] == Approx(x).margin(2e-5));
    largest = std::max(largest, std::abs(x));
  }
  CHECK(largest > 0.1);
}
