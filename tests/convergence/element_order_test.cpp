#include <catch2/catch.hpp>

#include "scene_motion.h"

using namespace floe;
using namespace floe::test;

namespace {

/// L = EI = rhoA = 1, tip force 3 sin(4 t)^4: large deflections, and a start
/// without a jump in the rate of the load, which no mesh resolves.
History cantilever(Formulation formulation, int elements) {
  return move(fill(R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: $elements}}
    section: {EA: 400, EI: 1, rhoA: 1}
    frame: pinned
joints: {clamp: {type: fixed, between: [ground, beam.start]}}
loads: {tip: {type: force, at: beam.end, force: [0, "3*sin(4*t)^4"]}}
motion: {end: 1, step: 1e-2}
probes: {tip: {at: beam.end}}
)yaml",
                   {{"elements", std::to_string(elements)}}),
              formulation);
}

/// log2 of the ratio of successive differences of the tip's history.
double order(Formulation formulation, const std::string& column) {
  const History a = cantilever(formulation, 8), b = cantilever(formulation, 16), c = cantilever(formulation, 32);
  return std::log2(relative_error(a, b, column) / relative_error(b, c, column));
}

}  // namespace

// Averaged strain: O(h^2) in the axial displacement and, through the tension, in the rest; bending alone is of order 4.
TEST_CASE("order: the moving tip converges in the elements at order two or better") {
  for (const Formulation formulation : {Formulation::nlffr, Formulation::cfr})
    for (const std::string column : {"tip.x", "tip.y"}) {
      INFO(name_of(formulation) << " " << column);
      CHECK(order(formulation, column) > 1.8);
    }
}
