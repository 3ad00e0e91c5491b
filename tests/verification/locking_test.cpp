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
