#include <catch2/catch.hpp>

#include "scene_motion.h"

using namespace floe;
using namespace floe::test;

namespace {

/// w_nl / w_l of the hinged immovable beam, L = EI = rhoA = 1, r = 1e-3. It starts through its straight shape with the
/// velocity v0 sin(pi x): v0^2/4 = pi^4 A^2/4 (1 + s (A/r)^2/8), the energy of the amplitude A (s = 1 exact).
double frequency_ratio(Formulation formulation, double amplitude, double s = 1) {
  const double A = amplitude * 1e-3, v0 = M_PI * M_PI * A * std::sqrt(1 + s * amplitude * amplitude / 8);
  const double e = s * amplitude * amplitude / 4, period = 2 / M_PI / std::sqrt(1 + 0.7 * e);
  const History at = move(fill(R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 16}}
    section: {EA: 1e6, EI: 1, rhoA: 1}
    strain: $strain
    reduction: {modes: {count: 1, alone: 1}, derivatives: all}
    initial: {deformation_rate: [0, "$v0*sin(pi*x)"]}
joints:
  left: {type: revolute, between: [ground, beam.start]}
  right: {type: revolute, between: [ground, beam.end]}
motion: {end: $end, step: $step}
probes: {middle: {at: beam.middle}}
)yaml",
                               {{"v0", number(v0)},
                                {"strain", formulation == Formulation::vm ? "pointwise" : "averaged"},
                                {"end", number(1.3 * period)},
                                {"step", number(period / 400)}}),
                          formulation);
  const auto zero = at.crossings("middle.y");
  REQUIRE(zero.size() >= 2);
  return 2 * M_PI / (2 * (zero[1] - zero[0])) / (M_PI * M_PI);
}

/// Woinowsky-Krieger: pi sqrt(1+e) / (2 K(m)), m = e / (2 (1+e)).
double closed_form(double e) {
  return M_PI * std::sqrt(1 + e) / (2 * std::comp_ellint_1(std::sqrt(e / (2 * (1 + e)))));
}

}  // namespace

TEST_CASE("hinged vibration: frequency over amplitude, Woinowsky-Krieger") {
  const double table[4][2] = {{.5, 1.02312635655}, {1, 1.08915817878}, {2, 1.31777606497}, {3, 1.62567661480}};
  for (const auto& [amplitude, ratio] : table) {
    INFO("A/r = " << amplitude);
    CHECK(closed_form(amplitude * amplitude / 4) == Approx(ratio).epsilon(1e-10));
    CHECK(frequency_ratio(Formulation::nlffr, amplitude) == Approx(ratio).epsilon(2e-4));
    CHECK(frequency_ratio(Formulation::vm_md, amplitude) == Approx(ratio).epsilon(2e-4));
  }
}

// One mode alone is the same oscillator with 3/2 of the cubic stiffness.
TEST_CASE("hinged vibration: a mode without its derivative is too stiff") {
  for (const double amplitude : {1., 3.})
    CHECK(frequency_ratio(Formulation::vm, amplitude, 1.5) ==
          Approx(closed_form(1.5 * amplitude * amplitude / 4)).epsilon(2e-4));
}
