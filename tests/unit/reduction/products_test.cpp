#include "floe/reduction/products.h"

#include <algorithm>
#include <catch2/catch.hpp>

#include "bodies_in_space.h"
#include "differences.h"

using namespace floe;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::body_of;
using testing::Kind;
using testing::SpatiallyConstrained;
using testing::What;

namespace {

/// A curved shell, clamped at a node, on modes and all their derivatives.
struct Reduced {
  SpatiallyConstrained constrained;
  reduction::Basis basis;
  body::FlexibleBody body;
  std::vector<char> follows;
  explicit Reduced(What what = What::curved, int modes = 4)
      : constrained(body_of(what, PETSC_COMM_WORLD, testing::Spread::metis), Kind::clamped, {0}),
        basis(constrained.basis(modes)),
        body(reduction::project(constrained.structure, basis)) {
    for (const auto& origin : basis.origins)
      if (origin.kept) follows.push_back(origin.kind == reduction::ColumnOrigin::Kind::derivative);
  }
  body::Elasticity with(double share) const { return reduction::with_fewer_products(body, follows, share); }
};

VectorXd force_of(const body::Elasticity& e, const VectorXd& q) {
  VectorXd f = VectorXd::Zero(q.size());
  body::ElasticityWork work;
  body::add_force(e, q, work, f);
  return f;
}

MatrixXd tangent_of(const body::Elasticity& e, const VectorXd& q) {
  MatrixXd K = MatrixXd::Zero(q.size(), q.size());
  body::ElasticityWork work;
  body::add_tangent(e, q, 1, work, K);
  return K;
}

/// The static deformation under a force, by Newton's method in steps of the force.
VectorXd equilibrium(const body::Elasticity& e, const VectorXd& force) {
  VectorXd q = VectorXd::Zero(force.size());
  for (int step = 1; step <= 20; ++step)
    for (int i = 0; i < 20; ++i)
      q -= tangent_of(e, q).partialPivLu().solve(force_of(e, q) - step / 20.0 * force).eval();
  REQUIRE((force_of(e, q) - force).norm() < 1e-7 * force.norm());
  return q;
}

}  // namespace

TEST_CASE("fewer products: a sum of squares with the same linear part, force and tangent its derivatives") {
  const Reduced r;
  const body::Elasticity& all = r.body.elasticity;
  const double share = GENERATE(0.003, 0.03, 0.3);
  const body::Elasticity some = r.with(share);
  CHECK(some.pairs.size() < all.pairs.size());
  CHECK(some.F.rows() < all.F.rows());
  CHECK(some.F.cols() == r.body.coordinates() + std::ssize(some.pairs));
  CHECK(std::is_sorted(some.pairs.begin(), some.pairs.end()));
  for (const auto& [a, b] : all.pairs)  // those of two modes: a body's stiffness under a force along it
    if (!r.follows[a] && !r.follows[b])
      CHECK(std::find(some.pairs.begin(), some.pairs.end(), std::pair(a, b)) != some.pairs.end());
  CHECK(testing::relative_error(some.linear_stiffness(), all.linear_stiffness()) < 1e-12);
  testing::Random random(3);
  const VectorXd unit = all.linear_stiffness().diagonal().cwiseSqrt().cwiseInverse();
  for (const double size : {1e-3, 1.0, 1e3}) {
    const VectorXd q = size * unit.cwiseProduct(random.vector(unit.size()));
    CHECK(body::energy(some, q) > 0);
    const auto energy = [&](const VectorXd& x) { return body::energy(some, unit.cwiseProduct(x)); };
    const auto force = [&](const VectorXd& x) {
      return unit.cwiseProduct(force_of(some, unit.cwiseProduct(x))).eval();
    };
    const VectorXd x = q.cwiseQuotient(unit);
    CHECK(testing::relative_error(force(x), testing::gradient(energy, x, 0.1 * size)) < 1e-8);
    const MatrixXd K = unit.asDiagonal() * tangent_of(some, q) * unit.asDiagonal();
    CHECK(testing::relative_error(K, testing::jacobian(force, x, 0.1 * size)) < 1e-8);
  }
}

TEST_CASE("fewer products: with a share of nothing all of them, and the same energy") {
  const Reduced r(GENERATE(What::curved, What::triangles, What::mixed));
  const body::Elasticity same = r.with(1e-300);
  testing::Random random(4);
  for (int i = 0; i < 4; ++i) {
    const VectorXd q = 0.3 * random.vector(r.body.coordinates());
    CHECK(body::energy(same, q) == Approx(body::energy(r.body.elasticity, q)).epsilon(1e-11));
    CHECK(testing::relative_error(force_of(same, q), force_of(r.body.elasticity, q)) < 1e-10);
  }
}

// Forces of one size on all modes; the deformation is of the size of the samples.
TEST_CASE("fewer products move the static deformation by about the share, and fewer the greater it is") {
  const Reduced r;
  const MatrixXd K = r.body.elasticity.linear_stiffness();
  const double length = std::sqrt(
      12 * (r.body.inertia.C0.trace() - r.body.inertia.s0.squaredNorm() / r.body.inertia.m) / r.body.inertia.m);
  std::size_t before = r.body.elasticity.pairs.size() + 1;
  testing::Random random(7);
  for (const double share : {0.003, 0.03, 0.3}) {
    const body::Elasticity some = r.with(share);
    CHECK(some.pairs.size() < before);
    before = some.pairs.size();
    double square = 0;
    constexpr int count = 8;
    for (int i = 0; i < count; ++i) {
      VectorXd force = VectorXd::Zero(r.body.coordinates());
      for (std::size_t j = 0; j < r.follows.size(); ++j)
        if (!r.follows[j]) force[static_cast<Eigen::Index>(j)] = random.number();
      force *= 0.05 * length * std::sqrt(r.body.inertia.m) / K.ldlt().solve(force).norm();
      const VectorXd exact = equilibrium(r.body.elasticity, force), q = equilibrium(some, force);
      square += (q - exact).squaredNorm() / exact.squaredNorm() / count;
    }
    INFO("share " << share << ", moved by " << std::sqrt(square));
    CHECK(std::sqrt(square) < 2 * share);
    CHECK(std::sqrt(square) > 0);
  }
}

TEST_CASE("products of bodies without derivatives stay, and all ranks keep the same") {
  const Reduced r;
  const body::Elasticity all = reduction::with_fewer_products(r.body, std::vector<char>(r.follows.size(), 0), 0.1);
  CHECK(all.pairs == r.body.elasticity.pairs);
  CHECK(all.F == r.body.elasticity.F);
  const body::Elasticity mine = r.with(0.03);
  std::vector<double> sums = {double(mine.pairs.size()), double(mine.F.rows()), mine.F.squaredNorm(), mine.F.sum()};
  std::vector<double> first = sums;
  MPI_Bcast(first.data(), 4, MPI_DOUBLE, 0, PETSC_COMM_WORLD);
  CHECK(sums == first);
}
