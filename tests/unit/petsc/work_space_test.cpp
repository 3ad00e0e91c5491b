#include <petscksp.h>

#include <catch2/catch.hpp>

#include "floe/petsc/error.h"
#include "floe/petsc/factorisation.h"
#include "floe/petsc/handle.h"

using namespace floe;
using petsc::check;

namespace {

/// [e B; B' 0] of n + n unknowns, B of a few diagonals: every pivot of the first half is put off, by the thousands.
petsc::MatHandle delaying(PetscInt n, bool singular = false) {
  petsc::MatHandle A;
  check(MatCreateAIJ(PETSC_COMM_WORLD, PETSC_DECIDE, PETSC_DECIDE, 2 * n, 2 * n, 40, nullptr, 40, nullptr, A.out()));
  PetscInt first = 0, end = 0;
  check(MatGetOwnershipRange(A, &first, &end));
  for (PetscInt i = first; i < end; ++i) {
    const bool upper = i < n;
    check(MatSetValue(A, i, i, upper ? 1e-14 : 0, INSERT_VALUES));
    for (const PetscInt k : {0, 1, 7, 31, 101}) {
      const PetscInt j = upper ? n + (i + k) % n : ((i - n - k) % n + n) % n;
      const double value = 1 + 0.1 * static_cast<double>((upper ? i : j) % 7) + static_cast<double>(k % 5);
      check(MatSetValue(A, i, j, singular && (i % n == 3 || j % n == 3) ? 0 : value, INSERT_VALUES));
    }
  }
  check(MatAssemblyBegin(A, MAT_FINAL_ASSEMBLY));
  check(MatAssemblyEnd(A, MAT_FINAL_ASSEMBLY));
  return A;
}

struct Solved {
  petsc::KspHandle ksp;
  double residual = 0;
  PetscInt room = 0, infog = 0;
};

/// A x = 1 with a work space that begins at `room` per cent of what is foreseen.
Solved solve(Mat A, PetscInt room, PetscInt bound = 0) {
  Solved s;
  PC pc = nullptr;
  Mat F = nullptr;
  petsc::VecHandle x, b, r;
  check(KSPCreate(PETSC_COMM_WORLD, s.ksp.out()));
  check(KSPSetOperators(s.ksp, A, A));
  check(KSPSetType(s.ksp, KSPPREONLY));
  check(KSPGetPC(s.ksp, &pc));
  check(PCSetType(pc, PCLU));
  check(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  check(PCFactorSetUpMatSolverType(pc));
  check(PCFactorGetMatrix(pc, &F));
  check(MatMumpsSetIcntl(F, 14, room));
  if (bound > 0) check(MatMumpsSetIcntl(F, 23, bound));
  check(MatCreateVecs(A, x.out(), b.out()));
  check(VecDuplicate(b, r.out()));
  check(VecSet(b, 1));
  check(KSPSolve(s.ksp, b, x));
  check(MatMult(A, x, r));
  check(VecAXPY(r, -1, b));
  check(VecNorm(r, NORM_INFINITY, &s.residual));
  check(MatMumpsGetIcntl(F, 14, &s.room));
  check(MatMumpsGetInfog(F, 1, &s.infog));
  return s;
}

}  // namespace

TEST_CASE("a factorisation whose work space is too small is made with more") {
  const petsc::MatHandle A = delaying(400);
  const Solved s = solve(A, 1);
  CHECK(petsc::why_failed(s.ksp) == "");
  CHECK(s.infog >= 0);
  CHECK(s.room >= 100);  // it was too small
  CHECK(s.residual < 1e-8);
  // once more with the same factor
  check(MatScale(A, 2));
  petsc::VecHandle x, b;
  check(MatCreateVecs(A, x.out(), b.out()));
  check(VecSet(b, 1));
  check(KSPSetOperators(s.ksp, A, A));
  check(KSPSolve(s.ksp, b, x));
  CHECK(petsc::why_failed(s.ksp) == "");
}

TEST_CASE("a work space that is bounded stays so") {
  const Solved s = solve(delaying(400), 1, 1);
  CHECK(s.infog < 0);
  CHECK(s.room == 1);
  CHECK(petsc::why_failed(s.ksp) != "");
}

TEST_CASE("a factorisation that was to raise its errors does") {
  const petsc::MatHandle A = delaying(60, true);
  petsc::KspHandle ksp;
  PC pc = nullptr;
  petsc::VecHandle x, b;
  check(KSPCreate(PETSC_COMM_WORLD, ksp.out()));
  check(KSPSetErrorIfNotConverged(ksp, PETSC_TRUE));
  check(KSPSetOperators(ksp, A, A));
  check(KSPSetType(ksp, KSPPREONLY));
  check(KSPGetPC(ksp, &pc));
  check(PCSetType(pc, PCLU));
  check(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  check(MatCreateVecs(A, x.out(), b.out()));
  check(VecSet(b, 1));
  CHECK_THROWS_WITH(check(KSPSolve(ksp, b, x)), Catch::Matchers::Contains("INFOG(1)=-10"));
  CHECK(petsc::factor_fault(ksp).singular);
}
