#include <catch2/catch.hpp>

#include "estimated.h"
#include "space_twin.h"

using namespace floe;
using namespace floe::test;

// Deformations at the start that modes and derivatives do not contain: the reduced model has them all the same, by
// basis vectors of their own. Closed forms of bars, and full order.

namespace {

const Rotated rotation;

/// A beam between two hinges of the ground, as long as its deformation makes it; EA 2e7, EI 166.66, 0.78 kg.
std::string between_hinges(const std::string& deformation, const std::string& reduction = "{modes: 6}") {
  return fill(R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 16}}
    section: {A: 1e-4, I: 8.333e-10}
    material: {E: 2e11, rho: 7800}
    frame: pinned
    reduction: $reduction
    initial: {deformation: $deformation}
joints:
  a: {type: revolute, between: [ground, beam.start]}
  b: {type: revolute, between: [ground, beam.end]}
motion: {end: 0.01, step: 2e-5}
probes: {mid: {at: beam.middle, quantity: deflection}, end: {at: beam.end, quantity: position}}
)yaml",
              {{"deformation", deformation}, {"reduction", reduction}});
}

}  // namespace

// The tension EA 0.002 = 40 kN stiffens the beam: f = sqrt(EI pi^4 + T pi^2)/(2 pi sqrt(rhoA)), here 5.0 times that of
// the beam without it.
TEST_CASE("a hinged beam that is stretched at the start vibrates as a string, in reduced models") {
  for (const Formulation formulation : {Formulation::vm_md, Formulation::vm, Formulation::nlffr}) {
    INFO(scene::name_of(formulation));
    const History at = move(between_hinges("[\"0.002*x\", \"1e-5*sin(pi*x)\"]"), formulation);
    CHECK(at["end.x"].front() == Approx(1.002).epsilon(1e-12));
    CHECK(at["mid.x"].back() == Approx(0.001).epsilon(1e-6));
    CHECK(at.energy.front().elastic == Approx(0.5 * 2e7 * 0.002 * 0.002).epsilon(1e-4));
    const double pi2 = M_PI * M_PI, stiffness = 166.66 * pi2 * pi2 + 2e7 * 0.002 * pi2,
                 period = 2 * M_PI / std::sqrt(stiffness / 0.78);
    const std::vector<double> zeros = at.crossings("mid.y");
    REQUIRE(zeros.size() >= 2);
    CHECK(2 * (zeros[1] - zeros[0]) == Approx(period).epsilon(2e-3));
  }
}

TEST_CASE("joints to the ground keep the position of an initially shortened beam, as in the full-order model") {
  const std::string text = between_hinges("[\"-1e-5*x\", \"1e-3*sin(pi*x) + 2e-4*sin(2*pi*x)\"]");
  const Estimated reduced = move_and_estimate(text, Formulation::vm_md);
  const History full = move(text, Formulation::nlffr);
  for (std::size_t i = 0; i < reduced.history.t.size(); ++i)
    CHECK(reduced.history["end.x"][i] == Approx(1 - 1e-5).epsilon(1e-12));
  CHECK(vector_error(reduced.history, full, "mid") < 1e-3);
  CHECK(reduced.estimate.deformation < 1e-2);
}

// A free bar, fixed at its end, let go stretched by e: c = sqrt(E/rho); its end moves as a triangle between +e L and
// -e L of period 4 L/c (d'Alembert).
TEST_CASE("a bar released from a stretched state: axial waves, no rigid bar") {
  const std::string text = R"yaml(
bodies:
  bar:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 24}}
    section: {EA: 1e4, EI: 1, rhoA: 1}
    frame: {type: clamped, at: start}
    reduction: {modes: 2, derivatives: none}
    initial: {deformation: ["1e-3*x", 0]}
joints: {a: {type: fixed, between: [ground, bar.start]}}
motion: {end: 0.04, step: 5e-5}
probes: {end: {at: bar.end}}
)yaml";
  const History full = move(text, Formulation::nlffr), at = move(text, Formulation::vm_md);
  for (const History* one : {&full, &at}) {
    CHECK(one->energy.front().elastic == Approx(0.5 * 1e4 * 1e-6).epsilon(1e-9));
    CHECK(one->at("end.x", 0.02) == Approx(-2e-3).epsilon(0.05));  // from where it was at the start
    CHECK((*one)["end.x"].back() == Approx(0).margin(0.25e-3));    // one basis vector: Rayleigh's frequency, 10 % high
  }
}

TEST_CASE("initial rates outside the span of the modes keep their kinetic energy; in space as in the plane") {
  const auto bar = [](const std::string& mesh, const std::string& section, const std::string& material,
                      const std::string& initial) {
    return fill(R"yaml(
bodies:
  bar:
    mesh: {line: {$mesh, elements: 12}}
    section: $section
    material: $material
    frame: mean-axis
    reduction: {modes: 2, derivatives: none}
    initial: {$initial}
motion: {end: 1e-3, step: 1e-4}
probes: {end: {at: bar.end, quantity: velocity}}
)yaml",
                {{"mesh", mesh}, {"section", section}, {"material", material}, {"initial", initial}});
  };
  const History plane = move(bar("from: [0, 0], to: [1, 0]", "{A: 1e-3, I: 1e-6}", "{E: 1e7, rho: 1000}",
                                 "deformation: [\"1e-3*(x - .5)\", 0], deformation_rate: [\"2*(x - .5)\", 0]"),
                             Formulation::vm_md),
                space = move(
                    bar("from: [0, 0, 0], to: [1, 0, 0]",
                        "{A: 1e-3, Iy: 1e-6, Iz: 1e-6, J: 2e-6, orientation: [0, 1, 0]}", "{E: 1e7, nu: .3, rho: 1000}",
                        "rotation: " + rotation.text() +
                            ", deformation: [\"1e-3*(x - .5)\", 0, 0], deformation_rate: [\"2*(x - .5)\", 0, 0]"),
                    Formulation::vm_md);
  for (const History* one : {&plane, &space}) {
    CHECK(one->energy.front().elastic == Approx(0.5 * 1e4 * 1e-6).epsilon(1e-6));
    CHECK(one->energy.front().kinetic == Approx(0.5 * 4. / 12).epsilon(2e-3));  // 1/2 int (2 (x - 1/2))^2 rhoA dx
  }
}

// What the modes and derivatives miss of the foreshortening is small beside it, and large beside the strain energy.
TEST_CASE("a free beam released from a large deflection without stretch: basis, and estimate of the reduction") {
  const std::string text = R"yaml(
gravity: [0, -9.81]
bodies:
  rod:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 10}}
    section: {A: 5e-5, I: 1e-10}
    material: {E: 7e9, rho: 1400}
    frame: mean-axis
    reduction: {modes: 4}
    initial:
      {velocity: [1, 3], angular_velocity: 5, deformation: ["-0.5*0.04^2*pi^2*(x/2 + sin(2*pi*x)/(4*pi))", "0.04*sin(pi*x)"]}
motion: {end: 0.6, step: 1e-3}
probes: {bend: {at: rod.middle, quantity: deflection}}
)yaml";
  const Estimated reduced = move_and_estimate(text, Formulation::vm_md);
  const History full = move(text, Formulation::nlffr);
  CHECK(reduced.history.energy.front().elastic == Approx(full.energy.front().elastic).epsilon(1e-3));
  const double error = vector_error(reduced.history, full, "bend");
  CHECK(error < 0.015);
  CHECK(reduced.estimate.probes[0] > 0.3 * error);
  CHECK(reduced.estimate.probes[0] < 3 * error);  // 20 times without the start of the estimate's own model
}

TEST_CASE("an initial state in the span of the basis adds no basis vector") {
  const History at = move(between_hinges("[0, \"0.01*sin(pi*x)\"]"), Formulation::vm_md);
  for (const auto& origin : at.model.bodies[0].origins) CHECK(origin.kind != reduction::ColumnOrigin::Kind::attachment);
}
