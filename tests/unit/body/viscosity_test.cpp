#include "floe/body/viscosity.h"

#include <catch2/catch.hpp>

#include "differences.h"
#include "random.h"

using namespace floe;
using testing::Random;

namespace {

/// Four coordinates of which 0, 2 and 3 have slope.
body::Elasticity sample() {
  Random random(13);
  body::Elasticity e;
  const Eigen::MatrixXd root = random.matrix(4, 4);
  e.bending = root.transpose() * root;
  e.pairs = {{0, 0}, {0, 2}, {0, 3}, {2, 2}, {2, 3}, {3, 3}};
  e.F = random.matrix(7, 10);
  return e;
}

Eigen::VectorXd force(const body::Elasticity& e, const Eigen::VectorXd& q, const Eigen::VectorXd& v) {
  Eigen::VectorXd f = Eigen::VectorXd::Zero(q.size());
  body::ViscosityWork work;
  body::add_viscous_force(e, q, v, 1, work, f);
  return f;
}

Eigen::MatrixXd tangent(const body::Elasticity& e, const Eigen::VectorXd& q, const Eigen::VectorXd& v, double wq,
                        double wv) {
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(q.size(), q.size());
  body::ViscosityWork work;
  body::add_viscous_tangent(e, q, v, wq, wv, work, K);
  return K;
}

}  // namespace

// With eps = F z(q): D = 1/2 v'K_b v + 1/2 |deps/dt|^2, deps/dt by a central difference of eps along v (eps is
// quadratic: exact), dD/dv by one of D (quadratic in v: exact).
TEST_CASE("viscous force is the gradient of half the dissipated power of the strain rates") {
  const body::Elasticity e = GENERATE(sample(), body::linearised(sample()));
  const Eigen::VectorXd q = Random(6).vector(4), v = Random(7).vector(4);
  body::Elasticity membrane = e;
  membrane.bending.setZero();
  const auto strain_energy = [&](const Eigen::VectorXd& x) { return body::energy(membrane, x); };
  const auto dissipation = [&](const Eigen::VectorXd& rate) {
    // |deps/dt|^2 from the energies of eps at q +- h v and their sum is not linear in eps; strains themselves:
    const auto strains = [&](const Eigen::VectorXd& x) -> Eigen::VectorXd {
      Eigen::VectorXd z = Eigen::VectorXd::Zero(e.F.cols());
      z.head(4) = x;
      for (std::size_t p = 0; p < e.pairs.size(); ++p)
        z[4 + static_cast<Eigen::Index>(p)] =
            (e.pairs[p].first == e.pairs[p].second ? 0.5 : 1) * x[e.pairs[p].first] * x[e.pairs[p].second];
      return e.F * z;
    };
    return 0.5 * rate.dot(e.bending * rate) + 0.5 * (0.5 * (strains(q + rate) - strains(q - rate))).squaredNorm();
  };
  REQUIRE(strain_energy(q) > 0);
  CHECK(testing::relative_error(force(e, q, v), testing::gradient(dissipation, v, 0.1)) < 1e-12);
  CHECK(v.dot(force(e, q, v)) == Approx(2 * dissipation(v)).epsilon(1e-12));
  CHECK(v.dot(force(e, q, v)) > 0);
}

TEST_CASE("viscous tangent holds the exact derivatives by q and by its rate") {
  const body::Elasticity e = GENERATE(sample(), body::linearised(sample()));
  const Eigen::VectorXd q = Random(8).vector(4), v = Random(9).vector(4);
  const auto of_q = [&](const Eigen::VectorXd& x) { return force(e, x, v); };
  const auto of_v = [&](const Eigen::VectorXd& x) { return force(e, q, x); };
  const Eigen::MatrixXd by_q = testing::jacobian(of_q, q, 0.1), by_v = testing::jacobian(of_v, v, 0.1);
  CHECK((tangent(e, q, v, 1, 0) - by_q).norm() <= 1e-12 * by_v.norm());
  CHECK(testing::relative_error(tangent(e, q, v, 0, 1), by_v) < 1e-12);
  CHECK(testing::relative_error(tangent(e, q, v, 0.3, -2), 0.3 * by_q - 2 * by_v) < 1e-12);
}

TEST_CASE("viscous force at rest is K q', and a rate without strain rates is not damped") {
  const body::Elasticity e = sample();
  const Eigen::VectorXd q = Random(10).vector(4), v = Random(11).vector(4), none = Eigen::VectorXd::Zero(4);
  CHECK(testing::relative_error(force(e, none, v), e.linear_stiffness() * v) < 1e-13);
  // one bar that draws in: eps = u + 1/2 w^2 stays zero while u' = -w w'
  body::Elasticity bar;
  bar.bending = Eigen::MatrixXd::Zero(2, 2);
  bar.pairs = {{1, 1}};
  bar.F = Eigen::RowVector3d(100, 0, 100);
  const Eigen::Vector2d at(-0.02, 0.2), rate(-0.2 * 3, 3);
  CHECK(force(bar, at, rate).norm() < 1e-10);
  CHECK((bar.linear_stiffness() * rate).norm() > 1e3);
}
