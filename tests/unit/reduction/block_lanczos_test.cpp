#include "../../../src/reduction/block_lanczos.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "floe/petsc/error.h"
#include "floe/petsc/handle.h"

using namespace floe;
using petsc::check;

namespace {

/// Entries (i, j, value) of a square matrix, each rank its own rows.
template <class Rows>
petsc::MatHandle matrix(PetscInt n, Rows&& rows) {
  petsc::MatHandle A;
  PetscInt first = 0, end = 0;
  check(MatCreateAIJ(PETSC_COMM_WORLD, PETSC_DECIDE, PETSC_DECIDE, n, n, 8, nullptr, 8, nullptr, A.out()));
  check(MatGetOwnershipRange(A, &first, &end));
  for (PetscInt i = first; i < end; ++i)
    rows(i, [&](PetscInt j, double value) { check(MatSetValue(A, i, j, value, INSERT_VALUES)); });
  check(MatAssemblyBegin(A, MAT_FINAL_ASSEMBLY));
  check(MatAssemblyEnd(A, MAT_FINAL_ASSEMBLY));
  check(MatSetOption(A, MAT_SYMMETRIC, PETSC_TRUE));
  return A;
}

petsc::MatHandle diagonal(PetscInt n, const std::function<double(PetscInt)>& value) {
  return matrix(n, [&](PetscInt i, auto&& set) { set(i, value(i)); });
}

/// Springs of one in a row between n masses, the ends constrained or free.
petsc::MatHandle chain(PetscInt n, bool constrained) {
  return matrix(n, [&](PetscInt i, auto&& set) {
    const bool end = i == 0 || i == n - 1;
    set(i, end && !constrained ? 1 : 2);
    if (i > 0) set(i - 1, -1);
    if (i < n - 1) set(i + 1, -1);
  });
}

double of_chain(PetscInt n, int k, bool constrained) {
  return 4 * std::pow(std::sin(k * std::numbers::pi / (2. * double(constrained ? n + 1 : n))), 2);
}

petsc::EpsHandle solver(Mat K, Mat M, int count, double target = 0) {
  petsc::EpsHandle eps;
  ST st = nullptr;
  KSP ksp = nullptr;
  PC pc = nullptr;
  reduction::register_block_lanczos();
  check(EPSCreate(PETSC_COMM_WORLD, eps.out()));
  check(EPSSetOperators(eps, K, M));
  check(EPSSetProblemType(eps, EPS_GHEP));
  check(EPSSetType(eps, reduction::block_lanczos));
  check(EPSSetTarget(eps, target));
  check(EPSSetTolerances(eps, 1e-10, PETSC_DEFAULT));
  check(EPSSetDimensions(eps, count, PETSC_DEFAULT, PETSC_DEFAULT));
  check(EPSGetST(eps, &st));
  check(STSetType(st, STSINVERT));
  check(STGetKSP(st, &ksp));
  check(KSPSetType(ksp, KSPPREONLY));
  check(KSPGetPC(ksp, &pc));
  check(PCSetType(pc, PCCHOLESKY));
  check(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  check(EPSSetFromOptions(eps));
  return eps;
}

/// The pairs satisfy K x = lambda M x, are M-orthonormal, and have these eigenvalues.
void check_pairs(EPS eps, Mat K, Mat M, const std::vector<double>& expected) {
  PetscInt converged = 0;
  check(EPSGetConverged(eps, &converged));
  REQUIRE(converged >= static_cast<PetscInt>(expected.size()));
  std::vector<petsc::VecHandle> x(expected.size());
  petsc::VecHandle Kx, Mx;
  check(MatCreateVecs(K, Kx.out(), Mx.out()));
  for (std::size_t i = 0; i < expected.size(); ++i) {
    double lambda = 0, off = 0;
    check(MatCreateVecs(K, x[i].out(), nullptr));
    check(EPSGetEigenpair(eps, static_cast<PetscInt>(i), &lambda, nullptr, x[i], nullptr));
    CHECK(lambda == Approx(expected[i]).epsilon(1e-11));
    check(MatMult(K, x[i], Kx));
    check(MatMult(M, x[i], Mx));
    check(VecAXPY(Kx, -lambda, Mx));
    check(VecNorm(Kx, NORM_2, &off));
    CHECK(off < 1e-8);
    for (std::size_t j = 0; j <= i; ++j) {
      double product = 0;
      check(VecDot(x[j], Mx, &product));
      CHECK(std::abs(product - (i == j)) < 1e-10);
    }
  }
}

std::vector<double> chain_values(PetscInt n, int count, bool constrained) {
  std::vector<double> values;
  for (int k = 1; k <= count; ++k) values.push_back(of_chain(n, k, constrained));
  return values;
}

}  // namespace

TEST_CASE("block Lanczos finds the lowest pairs of a chain of masses, with and without restarts") {
  const PetscInt n = 1500, space = GENERATE(-1, 36);
  const petsc::MatHandle K = chain(n, true), M = diagonal(n, [](PetscInt) { return 1; });
  const petsc::EpsHandle eps = solver(K, M, 12);
  if (space > 0) check(EPSSetDimensions(eps, 12, space, PETSC_DEFAULT));
  check(EPSSolve(eps));
  PetscInt steps = 0;
  check(EPSGetIterationNumber(eps, &steps));
  CHECK((steps * 8 > space || space < 0));
  check_pairs(eps, K, M, chain_values(n, 12, true));
}

TEST_CASE("block Lanczos finds eigenvalues as often as they repeat") {
  const PetscInt side = 30, n = side * side;  // a membrane of side x side masses: i and j may be exchanged
  const petsc::MatHandle M = diagonal(n, [](PetscInt) { return 2; }), K = matrix(n, [&](PetscInt at, auto&&set) {
                                                                        const PetscInt i = at / side, j = at % side;
                                                                        set(at, 4);
                                                                        if (i > 0) set(at - side, -1);
                                                                        if (i < side - 1) set(at + side, -1);
                                                                        if (j > 0) set(at - 1, -1);
                                                                        if (j < side - 1) set(at + 1, -1);
                                                                      });
  std::vector<double> expected;
  for (int i = 1; i <= 10; ++i)
    for (int j = 1; j <= 10; ++j) expected.push_back((of_chain(side, i, true) + of_chain(side, j, true)) / 2);
  std::sort(expected.begin(), expected.end());
  expected.resize(13);
  const petsc::EpsHandle eps = solver(K, M, 13);
  check(EPSSolve(eps));
  check_pairs(eps, K, M, expected);
  check(EPSSetDimensions(eps, 4, PETSC_DEFAULT, PETSC_DEFAULT));  // and again
  check(EPSSolve(eps));
  check_pairs(eps, K, M, {expected.begin(), expected.begin() + 4});
}

TEST_CASE("block Lanczos leaves out what is deflated") {
  const PetscInt n = 700;
  const petsc::MatHandle K = chain(n, false), M = diagonal(n, [](PetscInt) { return 1; });
  const petsc::EpsHandle eps = solver(K, M, 7, -1e-5);
  petsc::VecHandle rigid;
  check(MatCreateVecs(K, rigid.out(), nullptr));
  check(VecSet(rigid, 1));
  Vec deflated[1] = {rigid};
  check(EPSSetDeflationSpace(eps, 1, deflated));
  check(EPSSolve(eps));
  check_pairs(eps, K, M, chain_values(n, 7, false));
}

// K = (A c; c 1) with mass in the first half only: eigenvalues of A - c^2.
TEST_CASE("block Lanczos takes unknowns without mass") {
  const PetscInt half = 500, n = 2 * half;
  const double c = 1e-3;
  const petsc::MatHandle M = diagonal(n, [&](PetscInt i) { return i < half ? 1 : 0; });
  const petsc::MatHandle K = matrix(n, [&](PetscInt i, auto&& set) {
    set(i, i < half ? 2 : 1);
    set(i < half ? i + half : i - half, c);
    if (i < half && i > 0) set(i - 1, -1);
    if (i < half - 1) set(i + 1, -1);
  });
  std::vector<double> expected = chain_values(half, 9, true);
  for (double& value : expected) value -= c * c;
  const petsc::EpsHandle eps = solver(K, M, 9);
  check(EPSSolve(eps));
  PetscInt converged = 0;
  check(EPSGetConverged(eps, &converged));
  REQUIRE(converged >= 9);
  for (int i = 0; i < 9; ++i) {
    double lambda = 0;
    check(EPSGetEigenvalue(eps, i, &lambda, nullptr));
    CHECK(lambda == Approx(expected[i]).epsilon(1e-10));
  }
}

// Two different eigenvalues only: the space is full after two vectors, and whatever follows is made of nothing.
TEST_CASE("block Lanczos goes on where the space has no more directions") {
  const PetscInt n = 300;
  const petsc::MatHandle M = diagonal(n, [](PetscInt) { return 1; }),
                         K = diagonal(n, [](PetscInt i) { return i < 5 ? 1 : 4; });
  const petsc::EpsHandle eps = solver(K, M, 8);
  check(EPSSolve(eps));
  check_pairs(eps, K, M, {1, 1, 1, 1, 1, 4, 4, 4});
}

TEST_CASE("block Lanczos is refused where it cannot serve") {
  const petsc::MatHandle K = chain(200, true), M = diagonal(200, [](PetscInt) { return 1; });
  const petsc::EpsHandle other = solver(K, M, 3), small = solver(K, M, 3);
  ST st = nullptr;
  check(EPSGetST(other, &st));
  check(STSetType(st, STSHIFT));
  CHECK_THROWS_AS(check(EPSSolve(other)), petsc::Error);
  check(EPSSetDimensions(small, 3, 20, PETSC_DEFAULT));
  CHECK_THROWS_WITH(check(EPSSolve(small)), Catch::Contains("-eps_ncv 27"));
}
