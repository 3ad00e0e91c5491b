#include "../../../src/assembly/drive.h"

#include <catch2/catch.hpp>

#include "scene_motion.h"

using namespace floe;
using Catch::Matchers::Contains;

namespace {

/// A driven rod until t = 1 in steps of 0.01. @param drive  `angle: "t"` or `speed: "1"`
scene::Scene driven(const std::string& drive) {
  return scene::parse_scene(
      "bodies:\n  rod: {rigid: true, mesh: {line: {from: [0, 0], to: [1, 0], elements: 1}}, section: {rhoA: 1}}\n"
      "joints:\n  hub: {type: driven, between: [ground, rod.start], " +
          drive + "}\nmotion: {end: 1, step: 0.01}\n",
      "scene");
}

std::vector<assembly::DriveKink> kinks(const std::string& drive) {
  const scene::Scene scene = driven(drive);
  return assembly::drive_kinks(scene.joints[0], scene.motion);
}

}  // namespace

TEST_CASE("kinks of drives: where the rate jumps, and by how much; smooth drives have none") {
  for (const char* drive : {"angle: 'ramp(t, 0.1, 0.3)'", "speed: '5*pulse(t, 0.1, 0.3)'"}) {
    INFO(drive);
    const auto found = kinks(drive);
    REQUIRE(found.size() == 2);
    CHECK(found[0].before == Approx(0.1).epsilon(1e-9));
    CHECK(found[1].after == Approx(0.3).epsilon(1e-9));
    for (const auto& kink : found) CHECK(kink.velocity);
    CHECK(found[0].from == Approx(0).margin(1e-12));
    CHECK(found[0].to == Approx(5));
    CHECK(found[1].from == Approx(5));
    CHECK(found[1].to == Approx(0).margin(1e-12));
  }
  CHECK(kinks("angle: 'sin(5*t)*t'").empty());
  const auto bent = kinks("angle: 'max(t - 0.5, 0)^2'");  // its acceleration jumps, its rate does not
  REQUIRE(bent.size() == 1);
  CHECK(bent[0].before == Approx(0.5).epsilon(1e-6));
  CHECK_FALSE(bent[0].velocity);
}

TEST_CASE("drives of infinite acceleration are smoothed beside it and as written elsewhere") {
  const scene::Scene scene = driven("angle: 'sqrt(t^3)'");
  const dynamics::TimeFunction drive = assembly::drive_of(scene.joints[0], scene.motion);
  for (const double t : {0.11, 0.5, 1.0}) {
    CHECK(drive.value(t) == Approx(std::pow(t, 1.5)).epsilon(1e-9));
    CHECK(drive.rate(t) == Approx(1.5 * std::sqrt(t)).epsilon(1e-9));
    CHECK(drive.acceleration(t) == Approx(0.75 / std::sqrt(t)).epsilon(1e-9));
  }
  // over ten steps a polynomial with the same ends: its rate is that of its values, its acceleration that of its rate
  for (const double t : {0.01, 0.03, 0.05, 0.08}) {
    const double h = 1e-6;
    CHECK(drive.rate(t) == Approx((drive.value(t + h) - drive.value(t - h)) / (2 * h)).epsilon(1e-6));
    CHECK(drive.acceleration(t) == Approx((drive.rate(t + h) - drive.rate(t - h)) / (2 * h)).epsilon(1e-6));
    CHECK(drive.value(t) == Approx(std::pow(t, 1.5)).margin(2e-3));
  }
  CHECK(drive.value(0) == Approx(0).margin(1e-9));
  CHECK(drive.acceleration(0.1 - 1e-9) == Approx(drive.acceleration(0.1 + 1e-9)).epsilon(1e-4));
  const auto words = assembly::smoothed_drives(scene);
  REQUIRE(words.size() == 1);
  CHECK_THAT(words[0], Contains("joint hub") && Contains("is infinite at t = 0 s") && Contains("(10 steps)"));
}

TEST_CASE("a drive by speed rotates by its integral") {
  const scene::Scene scene = driven("speed: '3*cos(2*t)'");
  const dynamics::TimeFunction drive = assembly::drive_of(scene.joints[0], scene.motion);
  for (const double t : {0.0, 0.3, 1.0}) {
    CHECK(drive.value(t) == Approx(1.5 * std::sin(2 * t)).margin(1e-10));
    CHECK(drive.rate(t) == Approx(3 * std::cos(2 * t)));
    CHECK(drive.acceleration(t) == Approx(-6 * std::sin(2 * t)).margin(1e-10));
  }
}

// A pulse of a twentieth of a step, and the first instants behind a jump.
TEST_CASE("a drive by speed rotates by jumps that no point of a quadrature sees") {
  const scene::Scene pulse = driven("speed: 't > 0.1 ? (t < 0.1005 ? 10 : 1) : 1'"),
                     start = driven("speed: 't < 0.1 ? 0 : 5'");
  const dynamics::TimeFunction drive = assembly::drive_of(pulse.joints[0], pulse.motion),
                               begin = assembly::drive_of(start.joints[0], start.motion);
  CHECK(drive.value(0.05) == Approx(0.05).epsilon(1e-12));
  CHECK(drive.value(1) == Approx(1 + 9 * 5e-4).epsilon(1e-12));
  for (const double after : {1e-5, 1e-8, 1e-12}) CHECK(begin.value(0.1 + after) == Approx(5 * after).margin(1e-16));
}

TEST_CASE("drives that jump, are infinitely fast, or are not 0 at the start are refused") {
  CHECK_THROWS_WITH(kinks("angle: 'pulse(t, 0.5, 0.7)'"), Contains("jumps from 0 to 1 rad at t = 0.5"));
  CHECK_THROWS_WITH(kinks("angle: 'sqrt(t)'"), Contains("is infinite at t = 0"));
  const scene::Scene scene = driven("angle: '1 + t'");
  CHECK_THROWS_WITH(assembly::drive_of(scene.joints[0], scene.motion), Contains("is 1 at t = 0; expected 0"));
}
