#include <catch2/catch.hpp>

#include "paper_cantilever.h"

using namespace floe;
using namespace floe::test;

namespace {

/// (u, v) of the tip at t = 0.5, 1, 1.5.
void check_tip(const History& history, const double (&tip)[6], double margin) {
  for (int i = 0; i < 3; ++i) {
    INFO("t = " << 0.5 * (i + 1));
    CHECK(history.at("tip.x", 0.5 * (i + 1)) == Approx(tip[2 * i]).margin(margin));
    CHECK(history.at("tip.y", 0.5 * (i + 1)) == Approx(tip[2 * i + 1]).margin(margin));
  }
}

}  // namespace

// Independent converged computations, each with an error below 0.005: a geometrically exact beam, von Karman in one
// floating frame (pinned with theta + v'(0) = 0, clamped), linear elastic force in the pinned frame.
TEST_CASE("cantilever: tip of the geometrically exact beam by corotational elements") {
  check_tip(move(text_of({.elements = "40"}), Formulation::cfr), {-.5488, 10.1357, -5.9187, 20.0187, -1.6595, 3.7311},
            0.01);
}

TEST_CASE("cantilever: tip of the geometrically exact beam without rotary inertia") {
  check_tip(move(text_of({.elements = "40", .rotary = "false"}), Formulation::cfr),
            {-.5111, 9.9503, -6.0616, 19.9918, -1.4359, 3.7054}, 0.01);
}

TEST_CASE("cantilever: tip in von Karman strain, pinned frame") {
  check_tip(move(text_of({.elements = "40"}), Formulation::nlffr), {-.5570, 10.2012, -5.8877, 20.0052, -2.0382, 4.2024},
            0.01);
}

TEST_CASE("cantilever: tip in von Karman strain, clamped frame") {
  check_tip(move(text_of({.frame = "clamped", .elements = "40"}), Formulation::nlffr),
            {-.5643, 10.2443, -5.9504, 20.7361, -2.1514, 4.8360}, 0.01);
}

TEST_CASE("cantilever: tip with linear elastic forces, pinned frame") {
  check_tip(move(text_of({.elements = "40"}), Formulation::lffr), {-.5422, 10.0405, -2.2572, 22.6867, -.6811, 5.5355},
            0.01);
}
