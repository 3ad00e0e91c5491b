#include <catch2/catch.hpp>

#include "scene_motion.h"

using namespace floe;
using namespace floe::test;

namespace {

constexpr double pi = M_PI;

/// L = 1, EI = 1, r = 0.01, q L^4 / (EI r) = Q, hinges at both ends.
std::string scene_of(int elements, double Q, const std::string& strain, const std::string& reduction) {
  return fill(
      R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: $elements}}
    section: {EA: 1e4, EI: 1, rhoA: 1}
    strain: $strain
    reduction: $reduction
joints:
  left: {type: revolute, between: [ground, beam.start]}
  right: {type: revolute, between: [ground, beam.end]}
loads: {weight: {type: distributed, body: beam, force: [0, "$load*0.01*t"]}}
motion: {end: 1, step: 1}
probes: {middle: {at: beam.middle}}
)yaml",
      {{"elements", std::to_string(elements)}, {"load", number(Q)}, {"strain", strain}, {"reduction", reduction}});
}

struct Answer {
  double W, N;  // W/r, N L^2/EI
};

Answer answer(int elements, double Q, Formulation formulation, const std::string& strain = "averaged",
              const std::string& reduction = "{modes: 2}") {
  const History at = rest(scene_of(elements, Q, strain, reduction), formulation, 5);
  const PetscInt reaction = multipliers(*at.model.system)[0];  // along x at the left hinge
  return {100 * at["middle.y"][0], std::abs(everywhere(at.model.U)[reaction])};
}

}  // namespace

// Closed form: w from the tensioned beam, N from the stretch of the sine-like arc (both exact von Karman).
TEST_CASE("immovable hinged beam: deflection and tension under uniform load") {
  const Answer low = answer(32, 100, Formulation::nlffr), high = answer(32, 1000, Formulation::nlffr);
  CHECK(low.W == Approx(1.02727560541).epsilon(2e-6));
  CHECK(low.N == Approx(2.62920830636).epsilon(2e-6));
  CHECK(high.W == Approx(3.34492425434).epsilon(2e-6));
  CHECK(high.N == Approx(28.2690893276).epsilon(2e-6));
}

// Independent computation with both elements, at the digits shown.
TEST_CASE("immovable hinged beam: averaged against pointwise strain") {
  const double averaged[] = {3.34645, 3.34501, 3.34493}, pointwise[] = {3.27507, 3.32612, 3.34007};
  for (int i = 0; i < 3; ++i) {
    CHECK(answer(4 << i, 1000, Formulation::nlffr).W == Approx(averaged[i]).margin(1e-5));
    CHECK(answer(4 << i, 1000, Formulation::nlffr, "pointwise").W == Approx(pointwise[i]).margin(1e-5));
  }
}

// Geometrically exact elements see a shallow arc: the difference is of the order (W/L)^2 = 1e-3.
TEST_CASE("immovable hinged beam: corotational elements agree to the order of the slope squared") {
  CHECK(answer(32, 1000, Formulation::cfr).W == Approx(3.34492425434).epsilon(3e-3));
}

// One mode w = W sin(pi x/L): EI pi^4/2 W + s EA pi^4/8 W^3 = 2 q/pi with s = 1; without the column that lets the axis
// follow the arc, the mean of the squared strain (3/8) stands for the square of its mean (1/4): s = 3/2.
TEST_CASE("immovable hinged beam: modes alone overestimate the cubic stiffness by 3/2, derivatives make it exact") {
  const double Q = 1000;
  const auto stiffening = [&](const Answer& found) {  // s, from W in units of r
    return (2 * Q / pi - std::pow(pi, 4) / 2 * found.W) / (std::pow(pi, 4) / 8 * std::pow(found.W, 3));
  };
  const std::string modes = "{modes: {count: 1, alone: 1}, derivatives: all}";
  CHECK(stiffening(answer(32, Q, Formulation::vm, "pointwise", modes)) == Approx(1.5).epsilon(1e-4));
  CHECK(stiffening(answer(32, Q, Formulation::vm_md, "averaged", modes)) == Approx(1).epsilon(1e-4));
}

namespace {

/// The same beam between two joints of any type in any frame, Q = 500.
std::string between(const std::string& type, const std::string& frame) {
  return fill(R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 16}}
    section: {EA: 1e4, EI: 1, rhoA: 1}
    frame: $frame
    reduction: {modes: 5, derivatives: all}
joints:
  left: {type: $type, between: [ground, beam.start]}
  right: {type: $type, between: [ground, beam.end]}
loads: {weight: {type: distributed, body: beam, force: [0, "5*t"]}}
motion: {end: 1, step: 1}
probes: {middle: {at: beam.middle}, end: {at: beam.end}}
)yaml",
              {{"type", type}, {"frame", frame}});
}

}  // namespace

// Columns of a body that joints hold satisfy them: the second joint repeats what the first says, and only its own rows
// stand: 3 of 4 rows of two hinges, 3 of 6 of two clamps.
TEST_CASE("immovable beam: reduced between two joints, redundant constraints are eliminated") {
  for (const auto& [type, rows] : {std::pair{"revolute", 3}, {"fixed", 3}}) {
    INFO(type);
    const History full = rest(between(type, "pinned"), Formulation::nlffr, 4),
                  reduced = rest(between(type, "pinned"), Formulation::vm_md, 4);
    CHECK(reduced.model.multipliers == rows);
    CHECK(reduced["middle.y"][0] == Approx(full["middle.y"][0]).epsilon(1e-3));
    CHECK(std::abs(reduced["end.x"][0]) + std::abs(reduced["end.y"][0]) < 1e-12);
  }
}

// Seen from the tangent at one end the chord is tilted, and linear columns leave the far hinge to second order.
TEST_CASE("immovable beam: a frame that does not pass through both hinges is refused") {
  for (const std::string frame : {"clamped", "mean-axis"}) {
    const scene::Scene scene = scene::parse_scene(between("revolute", frame), "scene");
    CHECK_THROWS_WITH(assembly::build(scene, Formulation::vm_md, PETSC_COMM_WORLD),
                      Catch::Contains("frame: pinned") && Catch::Contains("beam"));
  }
  // between clamps the tangent is the chord
  const History full = rest(between("fixed", "clamped"), Formulation::nlffr, 4),
                reduced = rest(between("fixed", "clamped"), Formulation::vm_md, 4);
  CHECK(reduced["middle.y"][0] == Approx(full["middle.y"][0]).epsilon(1e-3));
}
