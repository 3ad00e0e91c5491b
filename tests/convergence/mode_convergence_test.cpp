#include <catch2/catch.hpp>

#include "paper_cantilever.h"

using namespace floe;
using namespace floe::test;

// Modes of the beam as its joint holds it, with all their derivatives: each mode more brings the tip closer to the full
// model of the same mesh; when the columns span every motion of the mesh the two are the same.
TEST_CASE("order: more modes with their derivatives converge to the full-order model") {
  const PaperCantilever coarse{.elements = "8", .end = "1.5", .step = "2.5e-3"};
  const History full = move(text_of(coarse), Formulation::nlffr);
  double last = INFINITY;
  for (const char* modes : {"2", "3", "4", "6"}) {
    PaperCantilever reduced = coarse;
    reduced.reduction = std::string("{modes: ") + modes + ", derivatives: all}";
    const double error = relative_error(move(text_of(reduced), Formulation::vm_md), full, "tip.y");
    INFO(modes << " modes: " << error);
    CHECK(error < last / 1.3);
    last = error;
  }
  CHECK(last < 5e-3);
}

TEST_CASE("order: a basis of all modes is the full-order model") {
  PaperCantilever all{.elements = "4", .end = "1.5", .step = "2.5e-3"};
  all.reduction = "{modes: {count: 12, alone: 12}, derivatives: none}";
  const History full = move(text_of(all), Formulation::nlffr), reduced = move(text_of(all), Formulation::vm);
  CHECK(relative_error(reduced, full, "tip.x") < 1e-6);
  CHECK(relative_error(reduced, full, "tip.y") < 1e-6);
}
