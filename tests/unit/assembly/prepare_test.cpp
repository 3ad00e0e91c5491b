#include <catch2/catch.hpp>
#include <cmath>

#include "building.h"

using namespace floe;
using testing::all_formulations;
using testing::at_start;
using testing::built;

namespace {

// An L-shaped body rotated by 30 degrees about its mesh's origin at (1, 2), which moves with (0.3, -0.4), rotating at
// 0.7.
const char* moving = R"yaml(
bodies:
  arm:
    mesh: {polyline: {points: [[0, 0], [2, 0], [2, 1]], elements: 4}}
    section: {EA: 1e4, EI: 10, rhoA: 1}
    frame: FRAME
    initial: {position: [1, 2], angle: pi/6, velocity: [0.3, -0.4], angular_velocity: 0.7}
motion: {end: 1, step: 0.1}
probes:
  p: {at: arm.end, quantity: position}
  v: {at: arm.end, quantity: velocity}
  d: {at: arm.end, quantity: displacement}
  r: {at: arm.p2, quantity: rotation}
)yaml";

std::string with_frame(std::string text, const std::string& frame) {
  return text.replace(text.find("FRAME"), 5, frame);
}

}  // namespace

TEST_CASE("a body starts where its mesh is placed, whatever its frame and formulation") {
  const std::string frame =
      GENERATE("pinned", "{type: pinned, from: end, to: start}", "{type: clamped, at: end}", "mean-axis");
  for (const auto formulation : all_formulations()) {
    INFO(frame << " " << scene::name_of(formulation));
    const auto values = at_start(built(with_frame(moving, frame), formulation));
    const double c = std::sqrt(3.) / 2, s = 0.5;
    const Eigen::Vector2d arm(2 * c - 1 * s, 2 * s + 1 * c),
        position = Eigen::Vector2d(1, 2) + arm,
        velocity = Eigen::Vector2d(0.3, -0.4) + 0.7 * Eigen::Vector2d(-arm.y(), arm.x());
    REQUIRE(values.size() == 7);
    for (int i = 0; i < 2; ++i) {
      CHECK(values[i] == Approx(position[i]).epsilon(1e-13));
      CHECK(values[2 + i] == Approx(velocity[i]).epsilon(1e-12));
      CHECK(std::abs(values[4 + i]) < 1e-14);
    }
    CHECK(std::abs(values[6]) < 1e-14);
  }
}

TEST_CASE("a deformation at the start is where its formula says, in every formulation") {
  const std::string text = R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [2, 0], elements: 8}}
    section: {EA: 1e6, EI: 10, rhoA: 1}
    initial: {deformation: [0, "0.01*sin(pi*x/2)"], deformation_rate: [0, "0.3*sin(pi*x/2)"], position: [0, 5]}
    reduction: {modes: {count: 5, of: frame}}
motion: {end: 1, step: 0.1}
probes:
  u: {at: beam.middle, quantity: displacement}
  p: {at: beam.middle, quantity: position}
  f: {at: beam.middle, quantity: deflection}
  v: {at: beam.middle, quantity: velocity}
  r: {at: beam.start, quantity: rotation}
)yaml";
  for (const auto formulation : all_formulations()) {
    INFO(scene::name_of(formulation));
    const auto values = at_start(built(text, formulation));
    CHECK(values[3] == Approx(5.01).epsilon(1e-5));
    CHECK(values[5] == Approx(0.01).epsilon(1e-3));
    CHECK(values[7] == Approx(0.3).epsilon(1e-3));
    CHECK(std::abs(values[1]) < 1e-14);  // displacements are measured from the start
  }
}

TEST_CASE("a frame that leaves a rotation free is an input error that names the frame") {
  const std::string text = with_frame(moving, "{type: pinned, from: start, to: [0.01, 0]}");
  CHECK_THAT(testing::complaint(text, scene::Formulation::nlffr), Catch::Contains("test.yaml:6"));
}
