#include <catch2/catch.hpp>

#include "space_twin.h"

using namespace floe;
using namespace floe::test;

namespace {

/// A round bar of 1 m and 20 mm along x, clamped at its start, with a mass.
std::string bar(const std::string& mass, const std::string& at = "end") {
  return fill(R"yaml(
bodies:
  bar:
    mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: 20}}
    section: {shape: circle, radius: 0.01, orientation: [0, 1, 0]}
    material: {E: 2e11, nu: 0.25, rho: 8000}
    masses: {disc: {at: $at, $mass}}
    reduction: {modes: 6}
joints: {clamp: {type: fixed, between: [ground, bar.start]}}
gravity: [0, 0, -10]
motion: {end: 1, step: 0.5}
probes: {tip: {at: bar.end, quantity: displacement}, turn: {at: bar.end, quantity: rotation}}
)yaml",
              {{"mass", mass}, {"at", at}});
}

constexpr double area = 1e-4 * M_PI, I = 1e-8 * M_PI / 4, EI = 2e11 * I, rhoA = 8000 * area, GJ = 2e11 / 2.5 * 2 * I;

/// First root of 1 + cos b cosh b + mu b (cos b sinh b - sin b cosh b) = 0.
double root(double mu) {
  const auto f = [&](double b) {
    return 1 + std::cos(b) * std::cosh(b) + mu * b * (std::cos(b) * std::sinh(b) - std::sin(b) * std::cosh(b));
  };
  double low = 0.1, high = 1.9;
  for (int i = 0; i < 60; ++i) (f((low + high) / 2) > 0 ? low : high) = (low + high) / 2;
  return low;
}

}  // namespace

TEST_CASE("point masses: a cantilever with a mass at its end") {
  for (const double mu : {0.1, 1., 10.}) {
    const double m = mu * rhoA, b = root(mu);
    const std::vector<double> omega = omega_of(bar("mass: " + number(m)));
    CHECK(omega[0] == Approx(b * b * std::sqrt(EI / rhoA)).epsilon(1e-3));  // rotary inertia: 1e-4
    CHECK(omega[1] == Approx(omega[0]).epsilon(1e-9));
  }
}

TEST_CASE("point masses: inertia about the bar twists it, and an offset mass under gravity") {
  // w tan(w L / c) = GJ / (J c) of a bar with a disc, c^2 = G / rho; J large: a spring with a third of the bar
  const double J = 0.01, own = 8000 * 2 * I;
  const std::vector<double> omega = omega_of(bar("mass: 1e-3, inertia: [0.01, 0.006, 0.006]"));
  const double twist = std::sqrt(GJ / (J + own / 3));
  CHECK(std::any_of(omega.begin(), omega.end(), [&](double w) { return std::abs(w / twist - 1) < 1e-3; }));
  const History at = rest(bar("mass: 0.5, offset: [0, 0.2, 0]"), Formulation::nlffr);
  CHECK(at["turn.rx"][0] == Approx(-0.5 * 10 * 0.2 / GJ).epsilon(1e-3));
  CHECK(at["tip.z"][0] == Approx(-(0.5 * 10 / 3 + rhoA * 10 / 8) / EI).epsilon(2e-3));
}

TEST_CASE("point masses: at coordinates as at a name, and refused where there is no node") {
  CHECK(omega_of(bar("mass: 2", "[1, 0, 0]"))[0] == Approx(omega_of(bar("mass: 2"))[0]).epsilon(1e-12));
  CHECK_THROWS_WITH(omega_of(bar("mass: 2", "[1, 0.1, 0]")),
                    Catch::Contains("the nearest node of the mesh is 0.1 from"));
  CHECK_THROWS_WITH(omega_of(bar("mass: 2", "edn")),
                    Catch::Contains("bodies.bar.masses.disc.at: the mesh has no place \"edn\"") &&
                        Catch::Contains("did you mean \"end\"?"));
  CHECK_THROWS_WITH(omega_of(bar("mass: 0")), Catch::Contains("bodies.bar.masses.disc.mass"));
  CHECK_THROWS_WITH(omega_of(bar("mass: 1, inertia: [1, 1, 3]")), Catch::Contains("which no body has"));
}

// The attachment modes of both ends and of the mass span all elastic dofs of four elements, and round-off offers more.
TEST_CASE("point masses: a basis that is complete has as many vectors as the body has elastic dofs") {
  const History at = move(R"yaml(
gravity: [0, 0, -9.81]
bodies:
  s:
    mesh: {line: {from: [0.1, 0, 0], to: [0.5, 0, 0.05], elements: 4}}
    section: {shape: tube, radius: 0.01, wall: 0.002, orientation: [0, 1, 0]}
    material: {E: 7e10, nu: 0.3, rho: 2700}
    masses: {m: {at: middle, mass: 0.3, offset: [0, 0.03, 0.02], inertia: [1e-4, 2e-4, 2e-4]}}
  p: {rigid: {mass: 1, centre: [0.7, 0, 0], inertia: [0.01, 0.01, 0.01]}}
  h: {rigid: {mass: 3, centre: [0, 0, 0], inertia: [0.1, 0.1, 0.1]}}
joints:
  g: {type: driven, between: [ground, h.centre], axis: [0, 0, 1], angle: "5*t"}
  f: {type: fixed, between: [{body: h, node: [0.1, 0, 0]}, s.start]}
  k: {type: fixed, between: [s.end, {body: p, node: [0.5, 0, 0.05]}]}
probes: {tip: {at: s.end}}
motion: {end: 0.01, step: 1e-3}
)yaml",
                          Formulation::vm_md);
  CHECK(at.model.bodies[0].columns <= 24);
  CHECK(std::isfinite(at["tip.z"].back()));
}
