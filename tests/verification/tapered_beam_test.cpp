// Beams of Nastran decks with taper, which are divided into pieces of uniform section.
#include <catch2/catch.hpp>

#include "eigenvalues.h"
#include "spatial_scenes.h"

using namespace floe;
using namespace floe::test;

namespace {

constexpr double E = 7e10, rho = 2700;

/// A free beam of 1 m, A from 4 to 1 cm^2, I1 from 3 to 1 and I2 from 2 to 0.5 times 1e-8 m^4, in so many CBEAM without
/// shear (K1 = K2 = 0).
std::string tapered_deck(int count) {
  std::string text = "BEGIN BULK\nMAT1,1,7.+10,,0.3,2700.\n";
  for (int i = 0; i <= count; ++i) text += fmt::format("GRID,{},,{:.6f},0.,0.\n", i + 1, double(i) / count);
  for (int e = 0; e < count; ++e) {
    const auto at = [&](double x) {
      return fmt::format("{:.5e},{:.5e},{:.5e},0.,1.E-8", 4e-4 - 3e-4 * x, 3e-8 - 2e-8 * x, 2e-8 - 1.5e-8 * x);
    };
    text += fmt::format("CBEAM,{},{},{},{},0.,1.,0.\nPBEAM,{},1,{}\n,NO,1.,{}\n,0.,0.\n", e + 1, e + 1, e + 1, e + 2,
                        e + 1, at(double(e) / count), at(double(e + 1) / count));
  }
  return text + "ENDDATA\n";
}

/// Rayleigh and Ritz with Legendre polynomials to degree 15: E I w''^2, rho A w^2 + rho I w'^2. [rad/s]
std::vector<double> ritz(double I_a, double I_b) {
  constexpr int n = 16, points = 4000;
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n, n), M = K;
  for (int p = 0; p < points; ++p) {
    const double x = (p + 0.5) / points, s = 2 * x - 1;
    Eigen::VectorXd P(n), D(n), DD(n);  // and derivatives by x
    P[0] = 1, P[1] = s, D[0] = 0, D[1] = 2, DD[0] = DD[1] = 0;
    for (int k = 2; k < n; ++k) {
      P[k] = ((2 * k - 1) * s * P[k - 1] - (k - 1) * P[k - 2]) / k;
      D[k] = D[k - 2] + 2 * (2 * k - 1) * P[k - 1];
      DD[k] = DD[k - 2] + 2 * (2 * k - 1) * D[k - 1];
    }
    const double A = 4e-4 - 3e-4 * x, I = I_a + (I_b - I_a) * x;
    K += E * I / points * DD * DD.transpose();
    M += rho / points * (A * P * P.transpose() + I * D * D.transpose());
  }
  const Eigen::VectorXd lambda = testing::eigenvalues(K, M);
  std::vector<double> omega;
  for (int i = 2; i < 5; ++i) omega.push_back(std::sqrt(lambda[i]));  // two rigid motions
  return omega;
}

}  // namespace

TEST_CASE("six bending frequencies of a free beam with taper, in 2, 4 and 8 elements") {
  const Scratch scratch;
  std::vector<double> expected = ritz(3e-8, 1e-8);
  for (const double omega : ritz(2e-8, 0.5e-8)) expected.push_back(omega);
  for (const auto& [count, bound] : {std::pair{2, 8e-3}, {4, 2e-3}, {8, 5e-4}}) {
    const std::string deck = (scratch.path / fmt::format("taper{}.bdf", count)).string();
    write_text(deck, tapered_deck(count));
    const std::vector<double> found =
        omega_of(fill("bodies: {b: {mesh: {file: {path: $deck}}, reduction: {modes: 8}}}\n", {{"deck", deck}}));
    for (const double omega : expected) {
      INFO(count << " elements, " << omega << " rad/s");
      const auto near = *std::min_element(
          found.begin(), found.end(), [&](double a, double b) { return std::abs(a - omega) < std::abs(b - omega); });
      CHECK(near == Approx(omega).epsilon(bound));
    }
  }
}
