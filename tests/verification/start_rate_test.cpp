#include <catch2/catch.hpp>

#include "paper_cantilever.h"

using namespace floe;
using namespace floe::test;

namespace {

/// Where the tip is at t = 0.04, under a force that begins with a rate: 2500 sin(9.5 t).
double tip(const std::string& elements, double step) {
  PaperCantilever cantilever;
  cantilever.elements = elements, cantilever.end = "0.04", cantilever.step = number(step);
  return move(text_of(cantilever), Formulation::nlffr)["tip.y"].back();
}

}  // namespace

// The frame of a pinned body rotates with what acts on the last element's small mass, and the elastic coordinates
// rotate it back: the rate of the first acceleration counts for both or for none. Counted by each coordinate's own
// stiffness, the error of the step has a part that grows with the number of elements.
TEST_CASE("a load that starts with a finite rate: order two in the step, the same on every mesh") {
  double leading[2];
  int mesh = 0;
  for (const std::string elements : {"20", "80"}) {
    const double a = tip(elements, 2e-3), b = tip(elements, 1e-3), c = tip(elements, 5e-4);
    INFO(elements << " elements: " << a - b << ", " << b - c);
    CHECK(std::log2((a - b) / (b - c)) == Approx(2).margin(0.1));
    leading[mesh++] = a - b;
  }
  CHECK(leading[0] == Approx(leading[1]).epsilon(0.04));
}
