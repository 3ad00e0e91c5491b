#include <catch2/catch.hpp>

#include "scene_motion.h"

using namespace floe;
using namespace floe::test;

namespace {

/// L = 1, EI = 1; the load counts P L^2/EI or M L/EI.
History cantilever(Formulation formulation, const std::string& frame, const std::string& loads,
                   const std::string& frames = "1", const std::string& EA = "1e8") {
  return rest(fill(R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 32}}
    section: {EA: $EA, EI: 1, rhoA: 1}
    frame: $frame
    frames: $count
joints: {clamp: {type: fixed, between: [ground, beam.start]}}
loads: {tip: $loads}
motion: {end: 1, step: 1}
probes:
  tip: {at: beam.end}
  turn: {at: beam.end, quantity: rotation}
)yaml",
                   {{"EA", EA}, {"frame", frame}, {"count", frames}, {"loads", loads}}),
              formulation, 10);
}

std::string force(double a) { return "{type: force, at: beam.end, force: [0, \"" + number(a) + "*t\"]}"; }
std::string moment(double m) { return "{type: moment, at: beam.end, moment: \"" + number(m) + "*t\"}"; }

}  // namespace

// Inextensible elastica under a dead load, closed form by elliptic integrals.
TEST_CASE("static cantilever: elastica by corotational elements") {
  const double table[4][3] = {{0.1, .033295319268, .000665399963},
                              {0.5, .16214357566, .015918962471},
                              {1, .30172077380, .056433236283},
                              {2, .49345748040, .16064172083}};
  for (const auto& [a, w, u] : table) {
    INFO("P L^2/EI = " << a);
    const History at = cantilever(Formulation::cfr, "pinned", force(a));
    CHECK(at["tip.y"][0] == Approx(w).epsilon(1e-4));
    CHECK(at["tip.x"][0] == Approx(-u).epsilon(1e-4));
  }
}

// Several floating frames converge to the elastica; the chord sees angles of 1/N of the whole.
TEST_CASE("static cantilever: frames in a row approach the elastica") {
  double last = INFINITY;
  for (const auto& [frames, error] : {std::pair{"1", 0.01}, {"2", 1e-3}, {"4", 1.5e-4}, {"8", 6e-5}}) {
    INFO(frames << " frames");
    const double off = std::abs(cantilever(Formulation::nlffr, "pinned", force(2), frames)["tip.y"][0] - .49345748040);
    CHECK(off < error);
    CHECK(off < last);
    last = off;
  }
}

// Clamped frame: the load stays across the axis, w = a/3, u = -1/2 int w'^2 = -a^2/15.
TEST_CASE("static cantilever: von Karman in the clamped frame") {
  for (const double a : {0.1, 1., 2.}) {
    const History at = cantilever(Formulation::nlffr, "clamped", force(a));
    CHECK(at["tip.y"][0] == Approx(a / 3).epsilon(1e-5));
    CHECK(at["tip.x"][0] == Approx(-a * a / 15).epsilon(1e-5));
  }
}

// Pinned frame: independent computation, at the digits shown.
TEST_CASE("static cantilever: von Karman in the pinned frame") {
  const History one = cantilever(Formulation::nlffr, "pinned", force(1)),
                two = cantilever(Formulation::nlffr, "pinned", force(2));
  CHECK(one["tip.y"][0] == Approx(.300736704).epsilon(1e-5));
  CHECK(one["tip.x"][0] == Approx(-.0561033).epsilon(1e-5));
  CHECK(two["tip.y"][0] == Approx(.489571).epsilon(1e-5));
  CHECK(two["tip.x"][0] == Approx(-.158279).epsilon(1e-5));
}

// v'' = m, v'(0) = -m/2 against the chord: chord 1 - m^2/24 at the angle m/2, tip rotated by m.
TEST_CASE("static cantilever: end moment in the pinned frame") {
  for (const double m : {0.5, 1., 2.}) {
    INFO("M L/EI = " << m);
    const History at = cantilever(Formulation::nlffr, "pinned", moment(m));
    const double x = 1 + at["tip.x"][0], y = at["tip.y"][0];
    CHECK(std::hypot(x, y) == Approx(1 - m * m / 24).epsilon(1e-6));
    CHECK(std::atan2(y, x) == Approx(m / 2).epsilon(1e-6));
    CHECK(at["turn.angle"][0] == Approx(m).epsilon(1e-6));
  }
}

// The arc of a circle: x = sin m / m, y = (1 - cos m) / m, here to a full turn.
TEST_CASE("static cantilever: end moment rolls corotational elements into a circle") {
  for (const double m : {1., M_PI, 2 * M_PI}) {
    INFO("M L/EI = " << m);
    const History at = cantilever(Formulation::cfr, "pinned", moment(m));
    CHECK(1 + at["tip.x"][0] == Approx(std::sin(m) / m).margin(1e-4));
    CHECK(at["tip.y"][0] == Approx((1 - std::cos(m)) / m).margin(1e-4));
    CHECK(at["turn.angle"][0] == Approx(m).epsilon(1e-4));
  }
}
