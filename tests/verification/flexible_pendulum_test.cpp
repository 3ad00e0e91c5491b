#include <catch2/catch.hpp>

#include "scene_motion.h"

using namespace floe;
using namespace floe::test;

namespace {

/// L = 1, EA = 1.2e4, EI = 1, rhoA = 1, g = 9.81, hinge, released while horizontal.
std::string scene_of(const std::string& elements, const std::string& step) {
  return fill(R"yaml(
gravity: [0, -9.81]
bodies:
  rod:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: $elements}}
    section: {EA: 1.2e4, EI: 1, rhoA: 1}
    frame: pinned
    reduction: {modes: 5, derivatives: all}
joints: {hinge: {type: revolute, between: [ground, rod.start]}}
motion: {end: 1, step: $step}
probes: {tip: {at: rod.end, quantity: position}}
)yaml",
              {{"elements", elements}, {"step", step}});
}

void check_tip(const History& at, const double (&table)[3][3], double margin) {
  for (const auto& [t, x, y] : table) {
    INFO("t = " << t);
    CHECK(at.at("tip.x", t) == Approx(x).margin(margin));
    CHECK(at.at("tip.y", t) == Approx(y).margin(margin));
  }
}

}  // namespace

// Independent converged computations: geometrically exact, and von Karman in the pinned frame.
TEST_CASE("flexible pendulum: tip of the geometrically exact rod") {
  check_tip(move(scene_of("20", "1e-3"), Formulation::cfr),
            {{.25, .90953, -.40740}, {.5, -.05782, -.99742}, {1, -.98765, .05193}}, 5e-4);
}

TEST_CASE("flexible pendulum: tip in von Karman strain, full and reduced") {
  const double table[3][3] = {{.25, .90978, -.40619}, {.5, -.05760, -.99741}, {1, -.98801, .05120}};
  check_tip(move(scene_of("20", "1e-3"), Formulation::nlffr), table, 5e-4);
  check_tip(move(scene_of("20", "5e-4"), Formulation::vm_md), table, 5e-4);
}

// Hinge and gravity keep the energy; the scheme's own damping is of the third order in the step.
TEST_CASE("flexible pendulum: energy is conserved") {
  const auto drift = [](const std::string& step) {
    const History at = move(scene_of("10", step), Formulation::vm_md);
    const auto total = [](const dynamics::Energy& e) { return e.kinetic + e.elastic + e.potential; };
    double worst = 0;
    for (const auto& energy : at.energy) worst = std::max(worst, std::abs(total(energy) - total(at.energy[0])));
    return worst / 4.905;  // m g L / 2
  };
  const double coarse = drift("2e-3"), fine = drift("1e-3");
  CHECK(coarse < 1e-3);
  CHECK(fine < coarse / 3.5);
}
