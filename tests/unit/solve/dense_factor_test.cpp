#include "../../../src/solve/dense_factor.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "floe/petsc/error.h"
#include "floe/petsc/handle.h"
#include "floe/petsc/values.h"

using namespace floe;
using petsc::check;

namespace {

/// Needs exchanges of rows: its diagonal is zero. J x = b for x_j = 1/(j + 1).
petsc::MatHandle with_zero_diagonal(PetscInt n, double factor) {
  petsc::MatHandle J;
  check(MatCreateSeqDense(PETSC_COMM_SELF, n, n, nullptr, J.out()));
  for (PetscInt i = 0; i < n; ++i)
    for (PetscInt j = 0; j < n; ++j)
      if (i != j) check(MatSetValue(J, i, j, factor * std::cos(1. + i * i + 3 * j), INSERT_VALUES));
  check(MatAssemblyBegin(J, MAT_FINAL_ASSEMBLY));
  check(MatAssemblyEnd(J, MAT_FINAL_ASSEMBLY));
  return J;
}

double worst_error(solve::DenseFactor& factor, Mat J, PetscInt n) {
  petsc::VecHandle x, b, y;
  check(MatCreateVecs(J, x.out(), b.out()));
  check(VecDuplicate(x, y.out()));
  for (PetscInt j = 0; j < n; ++j) check(VecSetValue(x, j, 1. / (j + 1), INSERT_VALUES));
  check(MatMult(J, x, b));
  PetscBool found = PETSC_FALSE;
  check(factor.factor(J, &found));
  REQUIRE(found);
  check(factor.solve(b, y));
  check(VecAXPY(y, -1, x));
  double worst = 0;
  check(VecNorm(y, NORM_INFINITY, &worst));
  return worst;
}

}  // namespace

TEST_CASE("dense factor: solves what it factored, and factors a matrix again that has changed") {
  for (const PetscInt n : {2, 7, 33}) {
    solve::DenseFactor factor;
    const petsc::MatHandle J = with_zero_diagonal(n, 1), other = with_zero_diagonal(n, -3);
    CHECK(worst_error(factor, J, n) < 1e-9);
    CHECK(worst_error(factor, other, n) < 1e-9);
    check(MatScale(J, 5));
    CHECK(worst_error(factor, J, n) < 1e-9);
    check(MatShift(J, 1));
    CHECK(worst_error(factor, J, n) < 1e-9);
  }
}

TEST_CASE("dense factor: a singular matrix is reported") {
  solve::DenseFactor factor;
  const petsc::MatHandle J = with_zero_diagonal(4, 0);
  PetscBool found = PETSC_TRUE;
  check(factor.factor(J, &found));
  CHECK_FALSE(found);
}
