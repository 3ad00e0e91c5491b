#include <catch2/catch.hpp>

#include "paper_cantilever.h"

using namespace floe;
using namespace floe::test;

// Rms of the axial tip history to t = 3 against a geometrically exact beam, relative to that history's: one frame 12 %,
// two 3 %, four 0.7 % (independent computation). The corotational reference has elements half as long.
TEST_CASE("cantilever: several floating frames reach large deflections") {
  const History exact = move(text_of({.elements = "40", .end = "3"}), Formulation::cfr);
  for (const auto& [frames, error] : {std::pair{"1", 0.12}, {"2", 0.03}, {"4", 0.007}}) {
    const History split = move(text_of({.frames = frames, .end = "3"}), Formulation::nlffr);
    const double found = relative_error(split, exact, "tip.x");
    INFO(frames << " frames: " << found);
    CHECK(found < 1.3 * error);
    CHECK(found > 0.3 * error);
  }
}
