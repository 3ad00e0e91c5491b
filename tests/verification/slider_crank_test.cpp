#include <catch2/catch.hpp>

#include "scene_motion.h"

using namespace floe;
using namespace floe::test;

namespace {

/// Rigid crank 0.15 at 150 rad/s, flexible rod 0.30 of 6 mm diameter, slider of 0.033378 kg that moves along x.
std::string scene_of(const std::string& end, const std::string& step, const std::string& rigid = "false") {
  return fill(R"yaml(
parameters: {c: 0.15, L: 0.30, d: 0.006, A: pi*d^2/4, I: pi*d^4/64, E: 2e11, rho: 7870, speed: 150, s: 0.04}
bodies:
  crank:
    rigid: true
    mesh: {line: {from: [0, 0], to: [c, 0], elements: 1}}
    section: {A: A, I: I}
    material: {E: E, rho: rho}
    initial: {angular_velocity: speed}
  rod:
    rigid: $rigid
    mesh: {line: {from: [0, 0], to: [L, 0], elements: 8}}
    section: {A: A, I: I}
    material: {E: E, rho: rho}
    frame: pinned
    reduction: {modes: 4, derivatives: all}
    initial: {position: [c, 0], velocity: [0, speed*c], angular_velocity: -speed*c/L}
  slider:
    rigid: true
    mesh: {line: {from: [-s/2, 0], to: [s/2, 0], elements: 2}}
    section: {rhoA: 0.033378/s}
    initial: {position: [c + L, 0]}
joints:
  motor: {type: driven, between: [ground, crank.start], angle: speed*t}
  crank-pin: {type: revolute, between: [crank.end, rod.start]}
  slider-pin: {type: revolute, between: [rod.end, slider.middle]}
  guide: {type: prismatic, between: [ground, slider.middle], axis: [1, 0]}
motion: {end: $end, step: $step}
probes:
  middle: {at: rod.middle, quantity: deflection}
  slider: {at: slider.middle, quantity: position}
)yaml",
              {{"rigid", rigid}, {"end", end}, {"step", step}});
}

// Deflection of the rod's middle over its length, geometrically exact: independent converged computation.
void check_deflection(const History& at, double margin) {
  const double table[][2] = {{.005, .015097}, {.01, .005309}, {.02, .00325}, {.025, -.00472}, {.05, .01295}};
  for (const auto& [t, w] : table) {
    if (t > at.t.back() + 1e-9) continue;
    INFO("t = " << t);
    CHECK(at.at("middle.y", t) / 0.3 == Approx(w).margin(margin));
  }
  const auto& w = at["middle.y"];
  const std::size_t greatest = std::max_element(w.begin(), w.begin() + w.size() / 2) - w.begin();
  CHECK(w[greatest] / 0.3 == Approx(.015388).margin(margin));
}

}  // namespace

TEST_CASE("slider-crank: deflection of the reduced rod") {
  check_deflection(move(scene_of("0.05", "1e-5"), Formulation::vm_md), 2e-4);
}

TEST_CASE("slider-crank: deflection of the full-order rods") {
  check_deflection(move(scene_of("0.025", "2e-5"), Formulation::nlffr), 2e-4);
  check_deflection(move(scene_of("0.025", "2e-5"), Formulation::cfr), 2e-4);
}

// Rigid: x = c cos a + sqrt(L^2 - c^2 sin^2 a), a = 150 t (closed form).
TEST_CASE("slider-crank: the rigid mechanism follows its kinematics") {
  const History at = move(scene_of("0.05", "1e-4", "true"), Formulation::vm_md);
  for (std::size_t i = 0; i < at.t.size(); ++i) {
    const double a = 150 * at.t[i], x = 0.15 * std::cos(a) + std::sqrt(0.09 - std::pow(0.15 * std::sin(a), 2));
    CHECK(at["slider.x"][i] == Approx(x).epsilon(1e-9));
    CHECK(std::abs(at["slider.y"][i]) < 1e-12);
  }
}
