#include "floe/dynamics/system.h"

#include <catch2/catch.hpp>

#include "systems.h"
#include "terms.h"

using namespace floe;
using dynamics::ConstraintLevel;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::numbers_of;
using testing::Random;

namespace {

/// Five points in the plane on a ring of damped springs, a joint between the first and the third.
testing::Terms ring(const std::vector<int>& first, int multipliers) {
  testing::Terms terms;
  Random random(131);
  std::vector<dynamics::Marker> nodes;
  for (int f : first) nodes.push_back(testing::node_marker(random, f));
  for (int i = 0; i < 5; ++i)
    terms.push_back(std::make_unique<dynamics::Spring>(nodes[i], nodes[(i + 1) % 5],
                                                       dynamics::SpringProperties{2, 0.3, 0.5, 1, 0.2, 0.1}));
  terms.push_back(std::make_unique<dynamics::Joint>(nodes[0], nodes[2], dynamics::Prismatic{}, multipliers));
  return terms;
}

/// All unknowns shared: dense. Multipliers stand before the distributed nodes: sparse.
dynamics::System dense() {
  dynamics::Coordinates c(PETSC_COMM_SELF);
  c.add_shared(15);
  c.add_shared(2, true);
  c.number();
  return {c, ring({0, 3, 6, 9, 12}, 15)};
}
dynamics::System sparse() {
  dynamics::Coordinates c(PETSC_COMM_SELF);
  c.add_shared(2, true);
  c.add_distributed(15, {});
  c.number();
  return {c, ring({2, 5, 8, 11, 14}, 0)};
}

MatrixXd matrix_of(Mat A, int n) {
  MatrixXd all(n, n);
  for (PetscInt i = 0; i < n; ++i)
    for (PetscInt j = 0; j < n; ++j) petsc::check(MatGetValue(A, i, j, &all(i, j)));
  return all;
}

struct Evaluated {
  VectorXd F;
  MatrixXd J;
  dynamics::Energy energy;
};

Evaluated evaluate(const dynamics::System& system, const VectorXd& q, const VectorXd& v, const VectorXd& a) {
  const auto vector = [&](const VectorXd& x) { return testing::vector_of(system, {x.begin(), x.end()}); };
  const petsc::VecHandle U = vector(q), V = vector(v), A = vector(a), F = system.create_vector();
  const petsc::MatHandle J = system.create_tangent();
  system.residual(0.2, U, V, A, ConstraintLevel::position, F);
  system.tangent(0.2, U, V, A, {1, 30, 900}, J);
  system.tangent(0.2, U, V, A, {1, 30, 900}, J);  // a second time: nothing is left of the first
  return {numbers_of(F), matrix_of(J, 17), system.energy(0.2, U, V)};
}

}  // namespace

TEST_CASE("a system is the sum of its terms, in a dense and in a sparse layout") {
  Random random(132);
  const VectorXd q = random.vector(17), v = random.vector(17), a = random.vector(17);
  VectorXd F = VectorXd::Zero(17);
  MatrixXd J = MatrixXd::Zero(17, 17);
  double elastic = 0;
  for (const auto& term : ring({0, 3, 6, 9, 12}, 15)) {
    const auto& own = term->coordinates();
    testing::State s(random, 0);
    s.q = q(own), s.v = v(own), s.a = a(own), s.t = 0.2;
    F(own) += testing::rows_of(*term, s);
    J(own, own) += testing::tangent_of(*term, s, {1, 30, 900});
    elastic += term->energy({0.2, s.q, s.v, s.a}).elastic;
  }
  for (const dynamics::System& system : {dense(), sparse()}) {
    const Evaluated found = evaluate(system, q, v, a);
    CHECK(testing::relative_error(found.F, F) < 1e-14);
    CHECK(testing::relative_error(found.J, J) < 1e-14);
    CHECK(found.energy.elastic == Approx(elastic).epsilon(1e-14));
  }
}

TEST_CASE("a replicated system has a dense tangent, a distributed one a sparse one") {
  const auto type = [](const dynamics::System& system) {
    const petsc::MatHandle J = system.create_tangent();
    MatType name = nullptr;
    petsc::check(MatGetType(J, &name));
    return std::string(name);
  };
  CHECK(type(dense()) == MATSEQDENSE);
  CHECK(type(sparse()) == MATSEQAIJ);
}

TEST_CASE("gather hands out local coordinates; the multipliers are told by their global numbers") {
  const dynamics::System system = sparse();
  std::vector<double> values(17);
  for (int i = 0; i < 17; ++i) values[i] = i;
  VectorXd local;
  system.gather(testing::vector_of(system, values), local);
  CHECK(local.head(2) == Eigen::Vector2d(15, 16));
  CHECK(local.tail(15) == VectorXd::LinSpaced(15, 0, 14));
  const petsc::IsHandle set = system.multipliers();
  const PetscInt* where = nullptr;
  PetscInt count = 0;
  petsc::check(ISGetLocalSize(set, &count));
  REQUIRE(count == 2);
  petsc::check(ISGetIndices(set, &where));
  CHECK((where[0] == 15 && where[1] == 16));
  petsc::check(ISRestoreIndices(set, &where));
}
