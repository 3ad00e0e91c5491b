#include "floe/body/elasticity.h"

#include <catch2/catch.hpp>

#include "differences.h"
#include "random.h"

using namespace floe;
using testing::Random;

namespace {

/// Four coordinates of which 0, 2 and 3 have slope; the energy is a full quartic in these.
body::Elasticity sample() {
  Random random(3);
  body::Elasticity e;
  const Eigen::MatrixXd root = random.matrix(4, 4);
  e.bending = root.transpose() * root;
  e.pairs = {{0, 0}, {0, 2}, {0, 3}, {2, 2}, {2, 3}, {3, 3}};
  e.F = random.matrix(7, 10);
  return e;
}

Eigen::VectorXd force(const body::Elasticity& e, const Eigen::VectorXd& q) {
  Eigen::VectorXd f = Eigen::VectorXd::Zero(q.size());
  body::ElasticityWork work;
  body::add_force(e, q, work, f);
  return f;
}

Eigen::MatrixXd tangent(const body::Elasticity& e, const Eigen::VectorXd& q, double weight = 1) {
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(q.size(), q.size());
  body::ElasticityWork work;
  body::add_tangent(e, q, weight, work, K);
  return K;
}

}  // namespace

TEST_CASE("elastic energy: U = 1/2 q'K_b q + 1/2 |F z|^2, written out") {
  const body::Elasticity e = sample();
  const Eigen::VectorXd q = Random(5).vector(4);
  Eigen::VectorXd z(10);
  z << q, q[0] * q[0] / 2, q[0] * q[2], q[0] * q[3], q[2] * q[2] / 2, q[2] * q[3], q[3] * q[3] / 2;
  CHECK(body::energy(e, q) == Approx(0.5 * q.dot(e.bending * q) + 0.5 * (e.F * z).squaredNorm()).epsilon(1e-14));
}

TEST_CASE("elastic force is the gradient of the energy and the tangent that of the force") {
  const body::Elasticity e = GENERATE(sample(), body::linearised(sample()));
  const Eigen::VectorXd q = Random(6).vector(4);
  const auto energy = [&](const Eigen::VectorXd& x) { return body::energy(e, x); };
  const auto forces = [&](const Eigen::VectorXd& x) { return force(e, x); };
  CHECK(testing::relative_error(force(e, q), testing::gradient(energy, q, 0.1)) < 1e-12);  // exact for quartics
  CHECK(testing::relative_error(tangent(e, q), testing::jacobian(forces, q, 0.1)) < 1e-12);
  CHECK(testing::relative_error(tangent(e, q, -2.5), -2.5 * tangent(e, q)) < 1e-14);
}

TEST_CASE("elastic force and tangent: central differences approach them with order 2") {
  const body::Elasticity e = sample();
  const Eigen::VectorXd q = Random(6).vector(4), d = Random(8).vector(4);
  const auto force_error = [&](double h) {
    return std::abs((body::energy(e, q + h * d) - body::energy(e, q - h * d)) / (2 * h) - force(e, q).dot(d));
  };
  const auto tangent_error = [&](double h) {
    return ((force(e, q + h * d) - force(e, q - h * d)) / (2 * h) - tangent(e, q) * d).norm();
  };
  CHECK(std::log2(force_error(0.02) / force_error(0.01)) == Approx(2).margin(1e-5));
  CHECK(std::log2(tangent_error(0.02) / tangent_error(0.01)) == Approx(2).margin(1e-5));
}

TEST_CASE("elastic energy is never negative, however far") {
  const body::Elasticity e = sample();
  Random random(9);
  for (int i = 0; i < 100; ++i) CHECK(body::energy(e, std::pow(10, i % 7 - 3) * random.vector(4)) >= 0);
}

TEST_CASE("the linearised body has the tangent at rest and nothing else") {
  const body::Elasticity e = sample(), linear = body::linearised(e);
  const Eigen::MatrixXd K = tangent(e, Eigen::VectorXd::Zero(4));
  CHECK(testing::relative_error(e.linear_stiffness(), K) < 1e-14);
  const Eigen::VectorXd q = 10 * Random(2).vector(4);
  CHECK(testing::relative_error(force(linear, q), K * q) < 1e-14);
  CHECK(body::energy(linear, q) == Approx(0.5 * q.dot(K * q)).epsilon(1e-13));
  CHECK(force(e, Eigen::VectorXd::Zero(4)).norm() == 0);
}

TEST_CASE("part of the coordinates and products is the whole with the others at zero") {
  const body::Elasticity e = sample();
  const body::Elasticity whole = body::part(e, 4, std::vector<char>(6, 1));
  const body::Elasticity some = body::part(e, 4, {1, 0, 1, 1, 0, 0});
  CHECK(some.pairs == std::vector<std::pair<int, int>>{{0, 0}, {0, 3}, {2, 2}});
  CHECK((whole.F.rows() == 7 && some.F.rows() == 7));
  body::Elasticity zeroed = e;
  for (const int p : {1, 4, 5}) zeroed.F.col(4 + p).setZero();
  const body::Elasticity first = body::part(e, 3, std::vector<char>(6, 1));
  CHECK(first.pairs == std::vector<std::pair<int, int>>{{0, 0}, {0, 2}, {2, 2}});
  CHECK(first.F.rows() == 6);  // the triangle of 7 rows and 3 + 3 columns
  Random random(12);
  for (int i = 0; i < 5; ++i) {
    Eigen::VectorXd q = 3 * random.vector(4);
    CHECK(body::energy(whole, q) == Approx(body::energy(e, q)).epsilon(1e-13));
    CHECK(testing::relative_error(force(some, q), force(zeroed, q)) < 1e-13);
    CHECK(testing::relative_error(tangent(some, q), tangent(zeroed, q)) < 1e-13);
    q[3] = 0;
    CHECK(body::energy(first, q.head(3)) == Approx(body::energy(e, q)).epsilon(1e-13));
  }
}

TEST_CASE("a body without membrane rows is its bending stiffness") {
  const body::Elasticity e{sample().bending, Eigen::MatrixXd(0, 4), {}};
  const Eigen::VectorXd q = Random(4).vector(4);
  CHECK(e.linear_stiffness() == e.bending);
  CHECK(force(e, q) == e.bending * q);
  CHECK(tangent(e, q) == e.bending);
  CHECK(body::energy(e, q) == Approx(0.5 * q.dot(e.bending * q)).epsilon(1e-15));
}
