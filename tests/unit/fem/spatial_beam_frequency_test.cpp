#include <catch2/catch.hpp>
#include <cmath>

#include "eigenvalues.h"
#include "floe/fem/spatial_beam.h"
#include "spatial_beam_chain.h"

using namespace floe;
using Eigen::Matrix3d;
using Eigen::VectorXd;
using testing::beam_chain;
using testing::chain_frequencies;
using testing::clamped_root;

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double L = 2;

/// The frequency found that lies nearest to `expected`, its relative error.
double error(const VectorXd& found, double expected) {
  return ((found.array() - expected).abs().minCoeff()) / expected;
}

/// Observed order of the error between n and 2n elements.
double order(double coarse, double fine) { return std::log2(coarse / fine); }

VectorXd cantilever(int n, const fem::SpatialBeamSection& s) {
  return chain_frequencies(beam_chain(n, L, s, clamped_root, {}, testing::some_rotation()));
}

}  // namespace

TEST_CASE("cantilever: bending frequencies in both planes, order 4") {
  // cos(bL) cosh(bL) = -1. Blevins, Formulas for natural frequency and mode shape, table 8-1
  const double bL[] = {1.87510406871196, 4.69409113297417};
  const double EIy = 9, EIz = 4, rhoA = 3;
  const fem::SpatialBeamSection s{1e8, EIy, EIz, 0, 1e7, rhoA, 0, 0, 0};
  const VectorXd coarse = cantilever(8, s), fine = cantilever(16, s);
  for (const double EI : {EIy, EIz})
    for (const double b : bL) {
      const double omega = b * b / (L * L) * std::sqrt(EI / rhoA);
      CHECK(error(fine, omega) < 6e-6);
      CHECK(order(error(coarse, omega), error(fine, omega)) == Approx(4).margin(0.1));
    }
}

TEST_CASE("cantilever with product of inertia: frequencies are those of the principal planes") {
  const fem::SpatialBeamSection principal{1e6, 9, 4, 0, 1e4, 3, 0.009, 0.004, 0};
  const double c = std::cos(0.5), d = std::sin(0.5);  // rotated: [Iz Iyz; Iyz Iy] = R diag(4, 9) R'
  fem::SpatialBeamSection s = principal;
  s.EIz = 4 * c * c + 9 * d * d, s.EIy = 4 * d * d + 9 * c * c, s.EIyz = (4 - 9) * c * d;
  s.rhoIz = s.EIz / 1000, s.rhoIy = s.EIy / 1000, s.rhoIyz = s.EIyz / 1000;
  const VectorXd a = cantilever(4, principal), b = cantilever(4, s);
  CHECK((a.head(8) - b.head(8)).cwiseAbs().maxCoeff() < 1e-7 * a[7]);
}

TEST_CASE("cantilever: axial and torsional frequencies, order 2") {
  // omega_k = (2k - 1) pi/2L sqrt(EA/rhoA), sqrt(GJ/rhoIp). Blevins, tables 8-16 and 8-19
  const double EA = 50, GJ = 0.8, rhoA = 3, rhoIy = 0.25, rhoIz = 0.2;
  const fem::SpatialBeamSection axial{EA, 1e7, 1e7, 0, 1e7, rhoA, 0, 0, 0};
  const fem::SpatialBeamSection torsion{1e7, 1e7, 1e7, 0, GJ, rhoA, rhoIy, rhoIz, 0};
  const VectorXd a8 = cantilever(8, axial), a16 = cantilever(16, axial);
  const VectorXd t8 = cantilever(8, torsion), t16 = cantilever(16, torsion);
  for (int k = 1; k <= 2; ++k) {
    const double wave = (2 * k - 1) * pi / (2 * L);
    const double along = wave * std::sqrt(EA / rhoA), twist = wave * std::sqrt(GJ / (rhoIy + rhoIz));
    CHECK(error(a16, along) < 4e-3);
    CHECK(order(error(a8, along), error(a16, along)) == Approx(2).margin(0.05));
    CHECK(error(t16, twist) < 4e-3);
    CHECK(order(error(t8, twist), error(t16, twist)) == Approx(2).margin(0.05));
  }
}

TEST_CASE("Rayleigh's beam, simply supported: rotary inertia lowers both planes as it should, order 4") {
  // omega^2 = EI b^4 / (rhoA + rhoI b^2), b = k pi / L. Rayleigh, Theory of sound, art. 186
  const double EIy = 9, EIz = 4, rhoA = 3, rhoIy = 0.5, rhoIz = 0.3;
  const fem::SpatialBeamSection s{1e7, EIy, EIz, 0, 1e7, rhoA, rhoIy, rhoIz, 0};
  const auto found = [&](int n) {
    return chain_frequencies(beam_chain(n, L, s, {0, 1, 2, 3, 6 * n + 1, 6 * n + 2}, {}, testing::some_rotation()));
  };
  const VectorXd coarse = found(4), fine = found(8);
  for (int k = 1; k <= 2; ++k) {
    const double b2 = std::pow(k * pi / L, 2);
    for (const double omega : {b2 * std::sqrt(EIy / (rhoA + rhoIy * b2)), b2 * std::sqrt(EIz / (rhoA + rhoIz * b2))}) {
      CHECK(error(fine, omega) < 3e-4);
      CHECK(order(error(coarse, omega), error(fine, omega)) == Approx(4).margin(0.15));
    }
  }
}

TEST_CASE("bending and torsion coupled by the shear centre: the simply supported beam's closed form, order 4 and 2") {
  // Timoshenko, Young & Weaver, Vibration problems in engineering, 4th ed., art. 5.23, without warping: with
  // w = W sin bx, theta = T sin bx and c = y_S - y_C:  EIy b^4 W = omega^2 rhoA (W_C),  GJ b^2 T = omega^2 (...)
  const double EIy = 9, GJ = 5, rhoA = 3, rhoI = 0.45, c = 0.3, b2 = std::pow(pi / L, 2);
  fem::SpatialBeamSection s{1e7, EIy, 1e7, 0, GJ, rhoA, 0, rhoI, 0};  // rhoIy = 0: no rotary inertia in bending w
  s.shear_centre << c, 0;
  Eigen::Matrix2d K, M;  // coordinates: w_S and theta; w_C = w_S - c theta
  K << EIy * b2 * b2, 0, 0, GJ * b2;
  M << rhoA, -rhoA * c, -rhoA * c, rhoI + rhoA * c * c;
  const Eigen::VectorXd lambda = testing::eigenvalues(K, M);
  const auto found = [&](int n) {
    return chain_frequencies(beam_chain(n, L, s, {0, 1, 2, 3, 6 * n + 1, 6 * n + 2, 6 * n + 3}));
  };
  const VectorXd coarse = found(8), fine = found(16);
  for (int k = 0; k < 2; ++k) {
    const double omega = std::sqrt(lambda[k]);
    CHECK(error(fine, omega) < 2e-3);
    CHECK(order(error(coarse, omega), error(fine, omega)) == Approx(2).margin(0.1));  // linear twist
  }
}
