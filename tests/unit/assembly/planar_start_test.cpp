#include <catch2/catch.hpp>
#include <cmath>

#include "building.h"

using namespace floe;
using scene::Formulation;
using testing::at_start;
using testing::built;

TEST_CASE("the deformed shape in space and its rate are what the formulas say, whatever the frame") {
  const std::string frame = GENERATE("pinned", "clamped", "mean-axis");
  const std::string text = R"yaml(
bodies:
  b:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 8}}
    section: {EA: 1e4, EI: 1, rhoA: 1}
    frame: )yaml" + frame + R"yaml(
    initial: {position: [1, 2], angle: pi/2, velocity: [0.5, 0], angular_velocity: 3,
              deformation: [0.01*x, "0.02+0.1*x^2"], deformation_rate: [0.3, "0.2*x^2+x"]}
motion: {end: 1, step: 0.1}
probes:
  p: {at: b.middle, quantity: position}
  v: {at: b.middle, quantity: velocity}
  q: {at: b.end, quantity: position}
  w: {at: b.end, quantity: velocity}
)yaml";
  for (const Formulation formulation : {Formulation::cfr, Formulation::nlffr, Formulation::lffr}) {
    INFO(frame << " " << scene::name_of(formulation));
    const std::vector<double> values = at_start(built(text, formulation));
    for (int place = 0; place < 2; ++place) {
      const double x = place ? 1 : 0.5, X = 1.01 * x, Y = 0.02 + 0.1 * x * x;  // rotated by 90 degrees: (-Y, X)
      const double expected[4] = {1 - Y, 2 + X, 0.5 - 3 * X - (0.2 * x * x + x), -3 * Y + 0.3};
      for (int i = 0; i < 4; ++i) CHECK(values[4 * place + i] == Approx(expected[i]).margin(1e-10));
    }
  }
}

namespace {

std::string shaped(const std::string& initial) {
  return R"yaml(
bodies:
  b:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 5}}
    section: {EA: 1e4, EI: 1, rhoA: 1}
    frame: clamped
    initial: {)yaml" +
         initial + R"yaml(}
motion: {end: 1, step: 0.1}
probes: {p: {at: {body: b, node: [0.2, 0]}, quantity: rotation}}
)yaml";
}

}  // namespace

TEST_CASE("a deformed shape ends where the body does: its formula need not go on behind it") {
  for (const char* keys : {"deformation: [0, \"0.01*x^1.5\"]", "deformation_rate: [0, \"0.01*sqrt(x*(1 - x))\"]"})
    CHECK(testing::complaint(shaped(keys), Formulation::cfr) == "");
}

TEST_CASE("a deformed shape that is no number between the ends is told with its key") {
  const std::string told =
      testing::complaint(shaped("deformation: [0, \"sqrt(abs(x - 0.5) - 0.2)\"]"), Formulation::nlffr);
  CHECK(told.find("test.yaml:7") == 0);
  CHECK(told.find("initial.deformation: \"sqrt(abs(x - 0.5) - 0.2)\" is not a number at x = 0.4") != std::string::npos);
  CHECK(testing::complaint(shaped("deformation_rate: [\"1/(x - 0.4)\", 0]"), Formulation::nlffr)
            .find("deformation_rate: \"1/(x - 0.4)\" is infinite at x = 0.4") != std::string::npos);
}
