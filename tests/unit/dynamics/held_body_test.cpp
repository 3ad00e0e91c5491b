#include <catch2/catch.hpp>

#include "differences.h"
#include "floe/dynamics/fixed_frame_body.h"
#include "random.h"
#include "terms.h"

using namespace floe;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

body::Elasticity elasticity() {
  body::Elasticity e;
  e.bending = (MatrixXd(3, 3) << 4, 1, 0, 1, 3, 0, 0, 0, 0).finished();
  e.pairs = {{0, 0}, {0, 1}, {1, 1}};
  e.F = (MatrixXd(2, 6) << 0, 0, 5, 1, 2, 3, 0.1, 0, 2, -1, 1, 2).finished();
  return e;
}

MatrixXd symmetric() { return (MatrixXd(3, 3) << 2, 0.3, 0, 0.3, 1, 0.2, 0, 0.2, 1.5).finished(); }

}  // namespace

TEST_CASE("a held body's forces do the work that its energy loses; its tangent is their derivative") {
  testing::Random random(3);
  const dynamics::FixedFrameBody body({0, 1, 2}, symmetric(), elasticity(), 0.1 * symmetric());
  const VectorXd q = random.vector(3), v = random.vector(3), a = random.vector(3);
  const auto rows = [&](const VectorXd& x, const VectorXd& y, const VectorXd& z) {
    VectorXd r = VectorXd::Zero(3);
    body.residual({0, x, y, z}, r);
    return r;
  };
  const double h = 1e-6;
  const double power =
      (body.energy({0, q + h * v, v + h * a, a}).kinetic + body.energy({0, q + h * v, v + h * a, a}).elastic -
       body.energy({0, q - h * v, v - h * a, a}).kinetic - body.energy({0, q - h * v, v - h * a, a}).elastic) /
      (2 * h);
  CHECK(rows(q, v, a).dot(v) == Approx(power + 0.1 * v.dot(symmetric() * v)).epsilon(1e-7));
  MatrixXd J = MatrixXd::Zero(3, 3);
  body.tangent({0, q, v, a}, {0.7, 0.3, 2}, J);
  for (int i = 0; i < 3; ++i) {
    const VectorXd e = h * VectorXd::Unit(3, i);
    const VectorXd column =
        (rows(q + 0.7 * e, v + 0.3 * e, a + 2 * e) - rows(q - 0.7 * e, v - 0.3 * e, a - 2 * e)) / (2 * h);
    CHECK((J.col(i) - column).norm() < 1e-7 * column.norm());
  }
}

TEST_CASE("a dead force pulls along its direction and stores what it can give back") {
  const MatrixXd S = (MatrixXd(3, 2) << 1, 0, 0, 2, 3, 1).finished();
  dynamics::DeadForce force({0, 1}, S, [](double t) { return Eigen::Vector3d(t, 1, -2); });
  const VectorXd q = Eigen::Vector2d(0.5, -1), zero = VectorXd::Zero(2);
  VectorXd r = VectorXd::Zero(2);
  force.residual({3, q, zero, zero}, r);
  CHECK(r[0] == Approx(-(3 - 6)));
  CHECK(r[1] == Approx(-(2 - 2)));
  CHECK(force.energy({3, q, zero, zero}).potential == 0);
  force.conservative = true;
  CHECK(force.energy({3, q, zero, zero}).potential == Approx(-(0.5 * (3 - 6) - 1 * (2 - 2))));
}
