#include <catch2/catch.hpp>

#include "scene_motion.h"

using namespace floe;
using namespace floe::test;

namespace {

/// The beam of Wu and Haug: L = 8, rotated up to Om in 15 s. Deflections are measured from the hub.
std::string scene_of(const std::string& Om, const std::string& end, const std::string& step) {
  return fill(R"yaml(
parameters: {Om: $Om, Ts: 15}
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [8, 0], elements: 16}}
    section: {A: 7.3e-5, I: 8.218e-9}
    material: {E: 6.895e10, rho: 2766.67}
    frame: clamped
    reduction: {modes: 5, derivatives: all}
joints:
  hub:
    type: driven
    between: [ground, beam.start]
    angle: "t < Ts ? Om/Ts*(t^2/2 + (Ts/(2*pi))^2*(cos(2*pi*t/Ts) - 1)) : Om*(t - Ts/2)"
motion: {end: $end, step: $step}
probes: {bent: {at: beam.end, quantity: deflection}, turned: {at: beam.start, quantity: rotation}}
)yaml",
              {{"Om", Om}, {"end", end}, {"step", step}});
}

// Independent converged computation in von Karman strain.
void check_tip(const History& at, double margin) {
  CHECK(at.at("bent.y", 2.5) == Approx(-.2145215).margin(margin));
  CHECK(at.at("bent.y", 5) == Approx(-.6272768).margin(margin));
  CHECK(at.at("bent.y", 7.5) == Approx(-.7150059).margin(margin));
  CHECK(at.at("bent.y", 10) == Approx(-.4381636).margin(margin));
  const auto& w = at["bent.y"];
  const std::size_t least = std::min_element(w.begin(), w.end()) - w.begin();
  CHECK(w[least] == Approx(-.758913).margin(margin));
  CHECK(at.t[least] == Approx(6.565).margin(0.02));
}

}  // namespace

TEST_CASE("spin-up: deflection of the tip, von Karman, full-order") {
  check_tip(move(scene_of("6", "10.5", "5e-3"), Formulation::nlffr), 1e-3);
}

TEST_CASE("spin-up: reduced, and the steady rotation afterwards") {
  const History at = move(scene_of("6", "20", "5e-3"), Formulation::vm_md);
  check_tip(at, 2e-3);
  double greatest = 0, stretch = 0;
  int steady = 0;
  for (std::size_t i = 0; i < at.t.size(); ++i)
    if (at.t[i] > 15.5) greatest = std::max(greatest, std::abs(at["bent.y"][i])), stretch += at["bent.x"][i], ++steady;
  CHECK(greatest < .0085 * 1.05);
  CHECK(stretch / steady == Approx(2.4654e-4).epsilon(0.05));
  CHECK(at.at("turned.angle", 20) == Approx(6 * 12.5).epsilon(1e-9));  // what the drive asks for
}

// Without the centrifugal tension the same beam is lost: linear elastic forces at Om = 4 grow without bound.
TEST_CASE("spin-up: linear elastic forces in the hub's frame are unstable") {
  double greatest = 0;
  try {
    const History at = move(scene_of("4", "20", "2e-2"), Formulation::lffr);
    for (const double w : at["bent.y"]) greatest = std::max(greatest, std::abs(w));
  } catch (const solve::MotionStopped&) {
    greatest = INFINITY;
  }
  CHECK(greatest > 1000);
}
