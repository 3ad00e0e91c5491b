#include <catch2/catch.hpp>

#include "eigenvalues.h"
#include "floe/petsc/values.h"
#include "linearised_motion.h"
#include "scene_motion.h"

using namespace floe;
using namespace floe::test;

namespace {

/// L = EI = rhoA = 1, L/r = 1e4 (the axis hardly stretches), rotating at gamma about its root.
std::string scene_of(double gamma, const std::string& frame, const std::string& root, const std::string& elements,
                     const std::string& EA = "1e8") {
  return fill(R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: $elements}}
    section: {EA: $EA, EI: 1, rhoA: 1}
    frame: $frame
    reduction: {modes: 8, derivatives: all}
    initial: {angular_velocity: $gamma}
joints: {root: {$root, between: [ground, beam.start]}}
motion: {end: 1, step: 1}
probes: {tip: {at: beam.end, quantity: deflection}}
)yaml",
              {{"EA", EA}, {"gamma", number(gamma)}, {"frame", frame}, {"root", root}, {"elements", elements}});
}

std::string driven(double gamma) { return "type: driven, angle: \"" + number(gamma) + "*t\""; }

/// The driven beam in steady rotation.
History steady(double gamma, const std::string& frame, Formulation formulation, const std::string& elements,
               const std::string& EA = "1e8") {
  History at = history_of(scene_of(gamma, frame, driven(gamma), elements, EA), formulation);
  solve::equilibrium(*at.model.system, 0, at.model.U, at.model.V);
  store(at, 0, at.model.U, at.model.V);
  return at;
}

/// Characteristic exponents of small motions about it.
std::vector<std::complex<double>> exponents(double gamma, const std::string& frame, Formulation formulation,
                                            const std::string& elements) {
  const History at = steady(gamma, frame, formulation, elements);
  return characteristic_exponents(*at.model.system, at.model.U, at.model.V);
}

std::vector<double> lag(double gamma, const std::string& frame, Formulation formulation,
                        const std::string& elements = "24") {
  return oscillations(exponents(gamma, frame, formulation, elements));
}

double growth(double gamma, Formulation formulation) {
  double greatest = 0;
  for (const auto& s : exponents(gamma, "clamped", formulation, "16")) greatest = std::max(greatest, s.real());
  return greatest;
}

/// Flap frequencies of a uniform beam hinged at the hub's centre: w'''' - (gamma^2/2 (1 - x^2) w')' = omega^2 w by
/// Galerkin's method with w = x^k, k = 1..12; the integrals are exact.
Eigen::VectorXd hinged_flap(double gamma) {
  const int n = 12;
  Eigen::MatrixXd K(n, n), M(n, n);
  for (int a = 1; a <= n; ++a)
    for (int b = 1; b <= n; ++b) {
      const double bending = a > 1 && b > 1 ? 1. * a * (a - 1) * b * (b - 1) / (a + b - 3) : 0;
      K(a - 1, b - 1) = bending + gamma * gamma / 2 * a * b * (1. / (a + b - 1) - 1. / (a + b + 1));
      M(a - 1, b - 1) = 1. / (a + b + 1);
    }
  return testing::eigenvalues(K, M).cwiseMax(0).cwiseSqrt();
}

}  // namespace

// Flap frequencies by independent converged computation; in the plane of rotation the centrifugal force has a part
// across the beam, and lag^2 = flap^2 - gamma^2 (closed form). Coriolis forces couple lag to stretch and change
// omega by a part of the order (gamma r/L)^2, 1e-6 here. The tension acts on the mean slope of an element: error
// O(h^2), removed by extrapolation from two meshes.
TEST_CASE("rotating beam: lag frequencies of the clamped beam") {
  const double flap[3][4] = {{2, 4.1373196, 22.6149220, 62.2731841},
                             {6, 7.3603730, 26.8090817, 66.6839144},
                             {12, 13.1701505, 37.6031123, 79.6144785}};
  for (const auto& row : flap)
    for (const std::string frame : {"pinned", "clamped"}) {
      INFO("gamma = " << row[0] << ", frame " << frame);
      const auto coarse = lag(row[0], frame, Formulation::nlffr, "12"), fine = lag(row[0], frame, Formulation::nlffr),
                 reduced = lag(row[0], frame, Formulation::vm_md);
      for (int i = 0; i < 3; ++i) {
        const double exact = std::sqrt(row[i + 1] * row[i + 1] - row[0] * row[0]);
        CHECK((4 * fine.at(i) - coarse.at(i)) / 3 == Approx(exact).epsilon(5e-5));
        CHECK(fine.at(i) == Approx(exact).epsilon(1e-3));
        CHECK(reduced.at(i) == Approx(fine.at(i)).epsilon(2e-3));
      }
    }
}

// Hinged at the hub's centre: flap omega_1 = gamma exactly, so the first lag motion is neutral (the beam rotates on).
TEST_CASE("rotating beam: lag frequencies of the hinged beam") {
  for (const double gamma : {2., 6.}) {
    INFO("gamma = " << gamma);
    const Eigen::VectorXd flap = hinged_flap(gamma);
    CHECK(flap[0] == Approx(gamma).epsilon(1e-8));
    // the drive needs no moment in steady rotation: the hinged beam is in the same state, without that multiplier
    const History driven_beam = steady(gamma, "pinned", Formulation::nlffr, "24"),
                  hinged = history_of(scene_of(gamma, "pinned", "type: revolute", "24"), Formulation::nlffr);
    {
      const Eigen::VectorXd state = everywhere(driven_beam.model.U);
      petsc::Values U(hinged.model.U);
      for (PetscInt i = U.first; i < U.end; ++i) U[i] = state[i];
    }
    const auto found = oscillations(characteristic_exponents(*hinged.model.system, hinged.model.U, hinged.model.V), 1);
    for (int i = 1; i < 3; ++i)
      CHECK(found.at(i - 1) == Approx(std::sqrt(flap[i] * flap[i] - gamma * gamma)).epsilon(3e-4));
  }
}

// Rotary inertia resists the rotation of sections in the plane and has no centrifugal force: Galerkin's method with
// w = x^k, k = 2..9, in 1/2 int w''^2 + gamma^2/2 (1 - x^2) w'^2 - gamma^2 w^2 and 1/2 int w.^2 + r w'.^2, r =
// rhoI/(rhoA L^2). 4.955 at gamma = 10 and r = 0.01; mass points that move linearly have 4.565.
TEST_CASE("rotating beam: lag frequencies with rotary inertia") {
  const auto exact = [](double gamma, double r) {
    constexpr int n = 8;
    Eigen::MatrixXd K(n, n), M(n, n);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        const double a = i + 2, b = j + 2, slopes = a * b / (a + b - 1), square = 1 / (a + b + 1);
        K(i, j) = a * (a - 1) * b * (b - 1) / (a + b - 3) + gamma * gamma / 2 * (slopes - a * b * square) -
                  gamma * gamma * square;
        M(i, j) = square + r * slopes;
      }
    return Eigen::VectorXd(testing::eigenvalues(K, M).cwiseSqrt());
  };
  CHECK(exact(10, 0.01)[0] == Approx(4.955).epsilon(2e-4));
  const auto lag_at = [](double gamma, const std::string& frame, Formulation formulation, const std::string& elements) {
    const std::string plain = "rhoA: 1}";
    std::string text = scene_of(gamma, frame, driven(gamma), elements);
    text.replace(text.find(plain), plain.size(), "rhoA: 1, rhoI: 0.01}");
    History at = history_of(text, formulation);
    solve::equilibrium(*at.model.system, 0, at.model.U, at.model.V);
    return oscillations(characteristic_exponents(*at.model.system, at.model.U, at.model.V));
  };
  for (const double gamma : {6., 10.})
    for (const std::string frame : {"pinned", "clamped"}) {
      INFO("gamma = " << gamma << ", frame " << frame);
      const auto coarse = lag_at(gamma, frame, Formulation::nlffr, "12"),
                 fine = lag_at(gamma, frame, Formulation::nlffr, "24"),
                 reduced = lag_at(gamma, frame, Formulation::vm_md, "24");
      for (int i = 0; i < 2; ++i) {
        CHECK((4 * fine.at(i) - coarse.at(i)) / 3 == Approx(exact(gamma, 0.01)[i]).epsilon(2e-4));
        CHECK(reduced.at(i) == Approx(fine.at(i)).epsilon(2e-3));
      }
    }
}

// Linear elastic forces in the clamped frame: lag^2 = beta_1^4 - gamma^2 becomes negative at gamma = beta_1^2
// = 3.516015, and beyond it the motion grows at sqrt(gamma^2 - beta_1^4). The von Karman strain carries the tension.
TEST_CASE("rotating beam: linear elastic forces buckle at gamma = 3.516, von Karman does not") {
  CHECK(growth(3.49, Formulation::lffr) < 1e-4);
  for (const double gamma : {3.54, 4., 6.})
    CHECK(growth(gamma, Formulation::lffr) ==
          Approx(std::sqrt(gamma * gamma - std::pow(3.5160152685, 2))).epsilon(1e-2));
  for (const double gamma : {3.54, 4., 6., 12.}) CHECK(growth(gamma, Formulation::nlffr) < 1e-4);
}

// EA u'' + rhoA Omega^2 (x + u) = 0: u(L) = sin(kL)/(k cos kL) - L, k = Omega sqrt(rhoA/EA).
TEST_CASE("rotating beam: steady stretch in closed form") {
  for (const double k : {0.01, 0.1, 0.5}) {
    INFO("k L = " << k);
    for (const Formulation formulation : {Formulation::nlffr, Formulation::vm_md}) {
      const History at = steady(100 * k, "clamped", formulation, "40", "1e4");
      const double exact = std::sin(k) / (k * std::cos(k)) - 1;
      CHECK(at["tip.x"][0] == Approx(exact).epsilon(formulation == Formulation::nlffr ? 5e-4 : 5e-2));
      CHECK(std::abs(at["tip.y"][0]) < 1e-9);
    }
  }
}
