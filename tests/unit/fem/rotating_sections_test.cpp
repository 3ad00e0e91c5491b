#include <algorithm>
#include <catch2/catch.hpp>
#include <functional>

#include "eigenvalues.h"
#include "floe/body/floating_frame.h"
#include "floe/body/spatial_frame.h"
#include "floe/fem/spatial_beam.h"

using namespace floe;
using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

/// K, C and M of small motions about steady rotation, one body clamped at its frame's origin; the frame rotates
/// steadily.
struct Steady {
  MatrixXd K, C, M;
  /// |Im s| of (s^2 M + s C + K) x = 0, ascending, each once.
  std::vector<double> omega() const {
    const Index n = K.rows();
    const Eigen::LLT<MatrixXd> mass(M);
    MatrixXd A = MatrixXd::Zero(2 * n, 2 * n);
    A.topRightCorner(n, n).setIdentity();
    A.bottomLeftCorner(n, n) = -mass.solve(K);
    A.bottomRightCorner(n, n) = -mass.solve(C);
    std::vector<double> all;
    const Eigen::VectorXcd exponents = testing::complex_eigenvalues(A);
    for (const auto& s : exponents)
      if (s.imag() > 0) all.push_back(s.imag());
    std::sort(all.begin(), all.end());
    return all;
  }
};

/// Beams of equal length along x from 0 to 1, the first node constrained; d = 2: rotating at spin.z.
Steady steady(int elements, int d, const Vector3d& spin,
              const std::function<fem::ElementMaps(double, double)>& element) {
  const int frame = d == 2 ? 3 : 6, per_node = frame, n = per_node * elements;
  std::vector<body::PlanarInertia> planar;
  std::vector<body::SpatialInertia> spatial;
  std::vector<body::Elasticity> elasticity;
  for (int e = 0; e < elements; ++e) {
    const fem::ElementMaps maps = element(double(e) / elements, double(e + 1) / elements);
    const MatrixXd free = e > 0 ? MatrixXd(MatrixXd::Identity(2 * per_node, 2 * per_node))
                                : MatrixXd(MatrixXd::Identity(2 * per_node, 2 * per_node).rightCols(per_node));
    const body::Inertia inertia = fem::inertia(maps, free);
    d == 2 ? planar.push_back(body::planar(inertia)) : spatial.push_back(body::spatial(inertia));
    elasticity.push_back(fem::elasticity(maps, free));
  }
  VectorXd rates = VectorXd::Zero(frame);
  d == 2 ? void(rates[2] = spin.z()) : void(rates.tail<3>() = spin);
  const auto sum = [&](const VectorXd& q, double wq, double wv, double wa, VectorXd& force) {
    MatrixXd J = MatrixXd::Zero(n, n);
    force = VectorXd::Zero(n);
    for (int e = 0; e < elements; ++e) {
      const Index first = std::max(0, e - 1) * per_node, k = elasticity[e].bending.rows(), size = frame + k;
      VectorXd at = VectorXd::Zero(size), v = VectorXd::Zero(size), r = v;
      const VectorXd a = v;
      at.tail(k) = q.segment(first, k), v.head(frame) = rates;
      MatrixXd own = MatrixXd::Zero(size, size);
      if (d == 2) {
        body::add_inertia_force(planar[e], at, v, a, r);
        body::add_inertia_tangent(planar[e], at, v, a, wq, wv, wa, own);
      } else {
        body::SpatialInertiaWork work;
        body::add_spatial_inertia_force(spatial[e], Matrix3d::Identity(), at, v, a, work, r);
        body::add_spatial_inertia_tangent(spatial[e], Matrix3d::Identity(), at, v, a, wq, wv, wa, work, own);
      }
      body::ElasticityWork work;
      const VectorXd elastic = at.tail(k);
      body::add_force(elasticity[e], elastic, work, r.tail(k));
      if (wq != 0) body::add_tangent(elasticity[e], elastic, wq, work, own.bottomRightCorner(k, k));
      J.block(first, first, k, k) += own.bottomRightCorner(k, k);
      force.segment(first, k) += r.tail(k);
    }
    return J;
  };
  VectorXd q = VectorXd::Zero(n), force;
  for (int i = 0; i < 8; ++i) {
    const MatrixXd K = sum(q, 1, 0, 0, force);
    q -= K.partialPivLu().solve(force);
  }
  return {sum(q, 1, 0, 0, force), sum(q, 0, 1, 0, force), sum(q, 0, 0, 1, force)};
}

/// Galerkin's method with w = x^k, k = 2..8, on a clamped beam of length 1: int w^2, int w'^2, int w''^2, int (1 - x^2)
/// w'^2.
struct Polynomials {
  static constexpr int n = 7;
  MatrixXd square = MatrixXd(n, n), slope = square, curvature = square, tension = square;
  Polynomials() {
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        const double a = i + 2, b = j + 2;
        square(i, j) = 1 / (a + b + 1), slope(i, j) = a * b / (a + b - 1);
        curvature(i, j) = a * (a - 1) * b * (b - 1) / (a + b - 3);
        tension(i, j) = a * b * (1 / (a + b - 1) - 1 / (a + b + 1));
      }
  }
};

fem::ElementMaps spatial(const fem::SpatialBeamSection& section, const Vector3d& orientation, double from, double to) {
  return fem::spatial_beam({{from, 0, 0}, {to, 0, 0}, orientation}, section);
}

}  // namespace

// L = EI = rhoA = 1, rhoI = 0.01: 4.955, where sections of mass points that move linearly have 4.565.
TEST_CASE("sections under spin in the plane: lag with rotary inertia at gamma = 10") {
  const double gamma = 10, rhoI = 0.01;
  const Polynomials p;
  const MatrixXd K = p.curvature + gamma * gamma * (p.tension / 2 - p.square), M = p.square + rhoI * p.slope;
  const double exact = std::sqrt(testing::eigenvalues(K, M)[0]);
  CHECK(exact == Approx(4.955).epsilon(2e-4));
  const auto lag = [&](int elements, int d) {
    return steady(elements, d, {0, 0, gamma},
                  [&](double from, double to) {
                    if (d == 2)
                      return fem::planar_beam({from, 0}, {to, 0}, {1e8, 1, 1, rhoI}, fem::MembraneStrain::averaged);
                    return spatial({1e8, 1e4, 1, 0, 1e4, 1, 0, rhoI, 0}, {0, 1, 0}, from, to);
                  })
        .omega()[0];
  };
  for (const int d : {2, 3}) {
    INFO("d = " << d);
    CHECK((4 * lag(16, d) - lag(8, d)) / 3 == Approx(exact).epsilon(2e-4));
  }
}

TEST_CASE("sections under spin in space: the propeller moment") {
  const double Iy = 1e-6, Iz = 0.01, GJ = 100 * 4 * (Iy + Iz) / (M_PI * M_PI), share = (Iz - Iy) / (Iz + Iy);
  const auto torsion = [&](const Vector3d& chord, double spin) {
    return steady(16, 3, {0, 0, spin},
                  [&](double from, double to) {
                    return spatial({1e8, 1e8 * Iy, 1e8 * Iz, 0, GJ, 1, Iy, Iz, 0}, chord, from, to);
                  })
        .omega()[0];
  };
  CHECK(torsion({0, 1, 0}, 10) == Approx(std::sqrt(100 + 100 * share)).epsilon(5e-4));
  CHECK(torsion({0, 0, 1}, 8) == Approx(std::sqrt(100 - 64 * share)).epsilon(2e-3));
}

// Seen from axes that rotate with the shaft at W, r = rhoI/(rhoA L^2):
//   omega^2 (A + r S) + 2 W omega A + W^2 (A - r S) - K = 0, both directions of whirl by the sign of omega.
TEST_CASE("sections under spin in space: whirl of a thick shaft, Rayleigh's beam") {
  const double r = 0.01, W = 2;
  const Polynomials p;
  const MatrixXd M = p.square + r * p.slope, K = W * W * (p.square - r * p.slope) - p.curvature;
  MatrixXd A = MatrixXd::Zero(14, 14);
  A.topRightCorner(7, 7).setIdentity();
  A.bottomLeftCorner(7, 7) = -M.llt().solve(K);
  A.bottomRightCorner(7, 7) = -2 * W * M.llt().solve(p.square);
  std::vector<double> exact;
  const Eigen::VectorXcd whirl = testing::complex_eigenvalues(A);
  for (const auto& each : whirl) exact.push_back(std::abs(each.real()));
  std::sort(exact.begin(), exact.end());
  const auto found = steady(16, 3, {W, 0, 0}, [&](double from, double to) {
                       return spatial({1e6, 1, 1, 0, 1e4, 1, r, r, 0}, {0, 1, 0}, from, to);
                     }).omega();
  CHECK(exact[0] == Approx(1.52702).epsilon(1e-5));
  for (int i = 0; i < 2; ++i) CHECK(found[i] == Approx(exact[i]).epsilon(2e-4));
}
