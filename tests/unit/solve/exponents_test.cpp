#include "../../../src/solve/exponents.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "eigenvalues.h"

using namespace floe::solve;
using Complex = std::complex<double>;
using Eigen::Matrix2d;
using Eigen::MatrixXd;

namespace {

/// All exponents by the plain linearisation in (y, s y).
Exponents of_companion(const Quadratic& problem) {
  const Eigen::Index n = problem.M.rows();
  MatrixXd T = MatrixXd::Zero(2 * n, 2 * n);
  T.topRightCorner(n, n).setIdentity();
  T.bottomLeftCorner(n, n) = -problem.M.partialPivLu().solve(problem.K);
  T.bottomRightCorner(n, n) = -problem.M.partialPivLu().solve(problem.C);
  const Eigen::VectorXcd values = testing::complex_eigenvalues(T);
  return {values.begin(), values.end()};
}

/// A disk of mass 1 on a massless shaft of stiffness k_x, k_y that rotates at W, in axes that rotate along (Jeffcott).
Quadratic jeffcott(double kx, double ky, double W, double internal = 0) {
  Quadratic problem{Matrix2d::Identity(), internal * Matrix2d::Identity(), Matrix2d::Zero()};
  problem.C += (Matrix2d() << 0, -2 * W, 2 * W, 0).finished();
  problem.K.diagonal() << kx - W * W, ky - W * W;
  return problem;
}

/// s^4 + s^2 (a + b + 4 W^2) + a b = 0, a = k_x - W^2, b = k_y - W^2.
std::vector<double> jeffcott_squares(double kx, double ky, double W) {
  const double a = kx - W * W, b = ky - W * W, p = a + b + 4 * W * W, root = std::sqrt(p * p - 4 * a * b);
  return {-2 * a * b / (p + root), -(p + root) / 2};
}

std::vector<Vibration> of(const Quadratic& problem, int count = 100) {
  return slowest_vibrations(problem, of_companion(problem), 1e-9, 1e-9, count);
}

/// Q' problem Q with a full Q of condition 3, so that nothing is diagonal.
Quadratic mixed(Quadratic problem) {
  const Eigen::Index n = problem.M.rows();
  MatrixXd Q = MatrixXd::Identity(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j) Q(i, j) += 0.5 * std::sin(3.1 + 1.3 * static_cast<double>(i * n + j)) / 2;
  for (MatrixXd* X : {&problem.M, &problem.C, &problem.K}) *X = Q.transpose() * *X * Q;
  return problem;
}

}  // namespace

TEST_CASE("an unequal shaft grows between its critical speeds, and only there") {
  for (const double ratio : {1.0001, 1.01, 1.2, 2.0, 10.0}) {
    for (const double share : {-0.1, 0.3, 0.5, 0.7, 1.1}) {
      const double W = 1 + share * (std::sqrt(ratio) - 1);
      INFO("ratio " << ratio << ", speed " << W);
      const std::vector<double> squares = jeffcott_squares(1, ratio, W);
      const std::vector<Vibration> found = of(mixed(jeffcott(1, ratio, W)));
      REQUIRE(found.size() == 2);
      CHECK(found[1].omega == Approx(std::sqrt(-squares[1])).epsilon(1e-9));
      CHECK(found[1].growth == 0);
      if (share > 0 && share < 1) {
        CHECK(found[0].omega == 0);
        CHECK(found[0].growth == Approx(std::sqrt(squares[0])).epsilon(1e-7));
      } else {
        CHECK(found[0].omega == Approx(std::sqrt(-squares[0])).epsilon(1e-7));
        CHECK(found[0].growth == 0);
      }
    }
  }
}

// s^2 + d s + k -+ 2 i W s - W^2 = 0 where C has the gyroscopic part alone besides d: y = x + i z.
TEST_CASE("internal damping makes a shaft grow beyond its critical speed") {
  for (const double W : {0.5, 2.0}) {
    const double d = 0.02;
    const std::vector<Vibration> found = of(mixed(jeffcott(1, 1, W, d)));
    REQUIRE(found.size() == 2);
    for (const Vibration& one : found) {
      double nearest = 1e9;
      for (const double sign : {-1., 1.}) {
        const Complex b(d, 2 * W * sign), root = std::sqrt(b * b - 4.0 * Complex(1 - W * W, 0));
        for (const Complex s : {(-b + root) / 2.0, (-b - root) / 2.0})
          nearest = std::min(nearest, std::abs(Complex(one.growth, one.omega) - s));
      }
      CHECK(nearest < 1e-10);
    }
    CHECK(std::any_of(found.begin(), found.end(), [](const Vibration& one) { return one.unstable(); }) == (W > 1));
  }
}

// Two modes of omega^2 = 1 and 2 that a follower force couples, K = (1, f; -f, 2): s^2 = -3/2 +- sqrt(1/4 - f^2).
TEST_CASE("flutter comes as one vibration that grows and one that decays") {
  const double f = 0.6;
  const Complex s = std::sqrt(Complex(-1.5, std::sqrt(f * f - 0.25)));
  Quadratic problem{Matrix2d::Identity(), Matrix2d::Zero(), (Matrix2d() << 1, f, -f, 2).finished()};
  const std::vector<Vibration> found = of(problem);
  REQUIRE(found.size() == 2);
  for (const Vibration& one : found) {
    CHECK(one.omega == Approx(std::abs(s.imag())).epsilon(1e-10));
    CHECK(std::abs(one.growth) == Approx(std::abs(s.real())).epsilon(1e-10));
  }
  CHECK(found[0].growth * found[1].growth < 0);
}

TEST_CASE("each divergence is told, and of overdamped motions those that last longest") {
  const MatrixXd one = MatrixXd::Identity(3, 3), nothing = MatrixXd::Zero(3, 3);
  Quadratic buckled{one, nothing, nothing};
  buckled.K.diagonal() << -25, -1, 4;
  std::vector<Vibration> found = of(mixed(buckled));
  REQUIRE(found.size() == 3);
  CHECK(found[0].growth == Approx(5));
  CHECK(found[1].growth == Approx(1));
  CHECK(found[2].omega == Approx(2));
  // (s + 1)(s + 20), (s + 2)(s + 40), (s - 3)(s + 7)
  Quadratic damped{one, nothing, nothing};
  damped.C.diagonal() << 21, 42, 4;
  damped.K.diagonal() << 20, 80, -21;
  found = of(mixed(damped));
  REQUIRE(found.size() == 3);
  CHECK(found[0].growth == Approx(3));
  CHECK(found[1].growth == Approx(-1));
  CHECK(found[2].growth == Approx(-2));
}

// Damping in proportion to stiffness makes fast vibrations decay without swinging, at 1/beta or faster: they are no
// reason to lose a slow one that grows. (s^2 + 50 s + 400: -10, -40)
TEST_CASE("overdamped motions do not stand before slower swings, and nothing that grows is left out") {
  const MatrixXd one = MatrixXd::Identity(5, 5), nothing = MatrixXd::Zero(5, 5);
  Quadratic problem{one, nothing, nothing};
  problem.C.diagonal() << -0.01, 0.02, 50, 60, -0.2;
  problem.K.diagonal() << 4, 9, 400, 500, 1e4;
  const std::vector<Vibration> found = of(mixed(problem), 2);
  REQUIRE(found.size() == 3);
  CHECK(found[0].omega == Approx(std::sqrt(4 - 0.005 * 0.005)));
  CHECK(found[0].growth == Approx(0.005));
  CHECK(found[1].growth == Approx(-0.01));
  CHECK(found[2].growth == Approx(0.1));
  CHECK(found[2].omega == Approx(100).epsilon(1e-4));
}

// A massless direction that a damper holds: (s + 4) beside a mass of 1 with s^2 + 9.
TEST_CASE("a direction without mass decays") {
  Quadratic problem{Matrix2d::Zero(), Matrix2d::Zero(), Matrix2d::Zero()};
  problem.M(0, 0) = 1, problem.K(0, 0) = 9, problem.C(1, 1) = 1, problem.K(1, 1) = 4;
  const std::vector<Vibration> found =
      slowest_vibrations(mixed(problem), {Complex(-4.0001, 0), Complex(0, 3), Complex(0, -3)}, 1e-9, 1e-9, 5);
  REQUIRE(found.size() == 2);
  CHECK(found[0].growth == Approx(-4).epsilon(1e-9));
  CHECK(found[1].omega == Approx(3));
}

// (s + 50)^2, a double root to round-off, beside s^2 + 9.
TEST_CASE("a decay whose oscillation is round-off is no vibration, a growth stays") {
  Quadratic problem{Matrix2d::Identity(), Matrix2d::Zero(), Matrix2d::Zero()};
  problem.C(0, 0) = 100, problem.K.diagonal() << 2500, 9;
  const Exponents found{{-50, 2e-4}, {-50, -2e-4}, {0, 3}, {0, -3}};
  const std::vector<Vibration> all = slowest_vibrations(mixed(problem), found, 1e-9, 1e-9, 1);
  REQUIRE(all.size() == 1);
  CHECK(all[0].omega == Approx(3));
  const std::vector<Vibration> more = slowest_vibrations(mixed(problem), found, 1e-9, 1e-9, 2);
  REQUIRE(more.size() == 2);
  CHECK(more[0].growth == Approx(-50));
  CHECK(more[0].omega == 0);
}

TEST_CASE("exponents of nothing and growth by round-off go, what is true stays") {
  Quadratic problem = mixed(jeffcott(1, 1.2, 1.05));
  const std::vector<double> squares = jeffcott_squares(1, 1.2, 1.05);
  const double growth = std::sqrt(squares[0]), omega = std::sqrt(-squares[1]);
  const Exponents found{{growth * (1 + 1e-5), 0}, {-growth, 0}, {20, 0}, {-20, 0}, {1e-4, omega},
                        {1e-4, -omega},           {3, 7},       {3, -7}};
  const std::vector<Vibration> all = slowest_vibrations(problem, found, 1e-9, 1e-9, 10);
  REQUIRE(all.size() == 2);
  CHECK(all[0].growth == Approx(growth).epsilon(1e-9));
  CHECK(all[1].omega == Approx(omega).epsilon(1e-9));
  CHECK(all[1].growth == 0);
}

// Stiffness over sixteen powers of ten: the greatest entries say nothing about the slowest motions, which are kept.
TEST_CASE("a true growth survives beside what is very much stiffer") {
  Quadratic problem{MatrixXd::Identity(4, 4), MatrixXd::Zero(4, 4), MatrixXd::Zero(4, 4)};
  problem.K.diagonal() << -1, 4, 1e8, 1e16;
  problem.C.topLeftCorner(2, 2) << 0, -0.5, 0.5, 0;
  // s^4 + s^2 (3 + 0.25) - 4 = 0
  const double square = (-3.25 + std::sqrt(3.25 * 3.25 + 16)) / 2;
  const Exponents found{{std::sqrt(square), 0}, {-std::sqrt(square), 0}, {0, 1e4}, {0, -1e4}, {50, 1e8}, {50, -1e8}};
  const std::vector<Vibration> all = slowest_vibrations(problem, found, 1e-6, 1e-6, 10);
  REQUIRE(all.size() == 3);
  CHECK(all[0].growth == Approx(std::sqrt(square)).epsilon(1e-9));
  CHECK(all[1].omega == Approx(1e4));
  CHECK(all[2].omega == Approx(1e8));
  CHECK(all[2].growth == 0);
}

TEST_CASE("overdamped motions do not count among the vibrations that were asked for") {
  const MatrixXd one = MatrixXd::Identity(4, 4), nothing = MatrixXd::Zero(4, 4);
  Quadratic problem{one, nothing, nothing};  // (s + 1)(s + 20), frequencies 2, 3, 5
  problem.C(0, 0) = 21;
  problem.K.diagonal() << 20, 4, 9, 25;
  const std::vector<Vibration> found = of(mixed(problem), 2);
  REQUIRE(found.size() == 3);
  CHECK(found[0].growth == Approx(-1));
  CHECK(found[1].omega == Approx(2));
  CHECK(found[2].omega == Approx(3));
}

TEST_CASE("only the slowest vibrations come, and all that are free") {
  Quadratic problem{MatrixXd::Identity(5, 5), MatrixXd::Zero(5, 5), MatrixXd::Zero(5, 5)};
  problem.K.diagonal() << 0, 1, 4, 9, 16;
  const std::vector<Vibration> all = slowest_vibrations(
      problem, {0, 1e-12, {0, 4}, {0, -4}, {0, 3}, {0, -3}, {0, 2}, {0, -2}, {0, 1}, {0, -1}}, 1e-6, 1e-6, 3);
  REQUIRE(all.size() == 3);
  CHECK(all[0].zero);
  CHECK(all[1].omega == 1);
  CHECK(all[2].omega == 2);
}
