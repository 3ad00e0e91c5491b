#include <catch2/catch.hpp>

#include "scene_motion.h"

using namespace floe;
using namespace floe::test;

namespace {

/// L = 1, EI = 1, EA = (L/r)^2, P L^2 / EI = 1.
double cantilever(int elements, double slenderness, const std::string& strain, const std::string& column) {
  return rest(fill(R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: $elements}}
    section: {EA: $slenderness^2, EI: 1, rhoA: 1}
    strain: $strain
    frame: clamped
joints: {clamp: {type: fixed, between: [ground, beam.start]}}
loads: {tip: {type: force, at: beam.end, force: [0, t]}}
motion: {end: 1, step: 1}
probes: {tip: {at: beam.end}}
)yaml",
                   {{"elements", std::to_string(elements)}, {"slenderness", number(slenderness)}, {"strain", strain}}),
              Formulation::nlffr, 4)
      .columns[column][0];
}

}  // namespace

// Exact von Karman: w/L = 1/3, u/L = -1/15. The pointwise strain's numbers are independent converged computations.
TEST_CASE("locking: the averaged strain gives the tip deflection at every slenderness") {
  for (const double slenderness : {100 * std::sqrt(70 / 585.), 200., 1e4, 1e5})
    for (const int elements : {10, 20, 40}) {
      INFO("L/r = " << slenderness << ", " << elements << " elements");
      CHECK(cantilever(elements, slenderness, "averaged", "tip.y") == Approx(1. / 3).margin(5e-6));
      CHECK(cantilever(elements, slenderness, "averaged", "tip.x") == Approx(-1. / 15).margin(5e-6));
    }
}

TEST_CASE("locking: the pointwise strain locks as published elements do") {
  CHECK(cantilever(10, 100 * std::sqrt(70 / 585.), "pointwise", "tip.y") == Approx(.30535).margin(2e-5));
  CHECK(cantilever(20, 100 * std::sqrt(70 / 585.), "pointwise", "tip.y") == Approx(.32467).margin(2e-5));
  CHECK(cantilever(40, 100 * std::sqrt(70 / 585.), "pointwise", "tip.y") == Approx(.33102).margin(2e-5));
  CHECK(cantilever(10, 200, "pointwise", "tip.y") == Approx(.17834).margin(2e-5));
  CHECK(cantilever(20, 200, "pointwise", "tip.y") == Approx(.23561).margin(2e-5));
  CHECK(cantilever(40, 200, "pointwise", "tip.y") == Approx(.28625).margin(2e-5));
}

// Two cantilevers, both clamped frames, whose ends a torsional spring joins: no frame moves, and no step begins anew.
// The twist between them remains below 0.1 rad; counted on from the rate at the event it grew to 12 rad.
TEST_CASE("the twist of a spring after an event, where all frames are clamped to the ground", "[verification]") {
  for (const Formulation formulation : {Formulation::nlffr, Formulation::vm_md}) {
    const History at = move(R"yaml(
bodies:
  a:
    mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: 4}}
    section: {shape: rectangle, width: 0.02, height: 0.01, orientation: [0, 1, 0]}
    material: {E: 7e10, nu: 0.3, rho: 2700}
    reduction: {modes: 4}
    frame: {type: clamped, at: start}
  b:
    mesh: {line: {from: [2, 0, 0], to: [1, 0, 0], elements: 4}}
    section: {shape: rectangle, width: 0.02, height: 0.01, orientation: [0, 1, 0]}
    material: {E: 7e10, nu: 0.3, rho: 2700}
    reduction: {modes: 4}
    frame: {type: clamped, at: start}
joints:
  ra: {type: fixed, between: [ground, a.start]}
  rb: {type: fixed, between: [ground, b.start]}
  m: {type: spherical, between: [a.end, b.end]}
  k: {type: spring, between: [a.end, b.end], axis: [0, 0, 1], torsional_stiffness: 5}
loads: {F: {type: force, at: a.end, force: [0, "60*sin(30*t)", 0]}}
events: {u: {unlock: m, at: 0.023}}
motion: {end: 4, step: 1e-3}
probes: {M: {joint: k, quantity: moment}, ra: {at: a.end, quantity: rotation}, rb: {at: b.end, quantity: rotation}}
)yaml",
                            formulation);
    double wrong = 0;
    for (std::size_t i = 0; i < at["M.z"].size(); ++i)
      wrong = std::max(wrong, std::abs(std::abs(at["M.z"][i]) - 5 * std::abs(at["rb.rz"][i] - at["ra.rz"][i])));
    CHECK(wrong < 0.02);
  }
}
