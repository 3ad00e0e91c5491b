#include "floe/petsc/factorisation.h"

#include <petscksp.h>

#include <catch2/catch.hpp>

#include "floe/petsc/error.h"
#include "floe/petsc/handle.h"

using namespace floe;
using Catch::Matchers::Contains;
using petsc::check;

namespace {

/// diag(1, 2, ..., 5) on one rank, its third entry as given.
petsc::MatHandle diagonal(double third) {
  petsc::MatHandle A;
  check(MatCreateSeqAIJ(PETSC_COMM_SELF, 5, 5, 1, nullptr, A.out()));
  for (PetscInt i = 0; i < 5; ++i) check(MatSetValue(A, i, i, i == 2 ? third : 1. + i, INSERT_VALUES));
  check(MatAssemblyBegin(A, MAT_FINAL_ASSEMBLY));
  check(MatAssemblyEnd(A, MAT_FINAL_ASSEMBLY));
  return A;
}

/// A x = 1 by a preconditioner alone, LU by a package where one is named.
petsc::KspHandle solved(Mat A, PCType type, const char* package = nullptr) {
  petsc::KspHandle ksp;
  petsc::VecHandle x, b;
  PC pc = nullptr;
  check(KSPCreate(PETSC_COMM_SELF, ksp.out()));
  check(KSPSetOperators(ksp, A, A));
  check(KSPSetType(ksp, KSPPREONLY));
  check(KSPSetOptionsPrefix(ksp, "of_this_test_"));
  check(KSPGetPC(ksp, &pc));
  check(PCSetType(pc, type));
  if (package) check(PCFactorSetMatSolverType(pc, package));
  check(MatCreateVecs(A, x.out(), b.out()));
  check(VecSet(b, 1));
  check(KSPSolve(ksp, b, x));
  return ksp;
}

}  // namespace

TEST_CASE("what MUMPS' INFOG(1) means: memory, its bound, work space, singular, disk; the option with its prefix") {
  CHECK_THAT(petsc::mumps_words(-13, 700, "a_"),
             Contains("700 entries short") && Contains("-a_mat_mumps_icntl_22 1") && !Contains("million"));
  CHECK_THAT(petsc::mumps_words(-7, -3, "a_"), Contains("3 million entries short"));
  CHECK_THAT(petsc::mumps_words(-5, 1, ""), Contains("memory ran out"));
  CHECK_THAT(petsc::mumps_words(-19, 0, "b_"), Contains("-b_mat_mumps_icntl_23"));
  for (const PetscInt small : {-8, -9, -11, -12, -14, -15, -17, -20})
    CHECK_THAT(petsc::mumps_words(small, 0, "c_"), Contains("work space") && Contains("-c_mat_mumps_icntl_14 1000"));
  for (const PetscInt singular : {-6, -10}) CHECK_THAT(petsc::mumps_words(singular, 0, ""), Contains("singular"));
  CHECK_THAT(petsc::mumps_words(-90, 0, ""), Contains("MUMPS_OOC_TMPDIR"));
  CHECK_THAT(petsc::mumps_words(-999, 0, ""), Contains("users' guide"));
}

TEST_CASE("a factor's fault: none, a pivot of PETSc's own, a singular matrix of MUMPS'") {
  const petsc::MatHandle good = diagonal(3), bad = diagonal(0);
  for (const auto& [type, package] :
       {std::pair<PCType, const char*>{PCLU, MATSOLVERPETSC}, {PCLU, MATSOLVERMUMPS}, {PCJACOBI, nullptr}}) {
    const petsc::KspHandle ksp = solved(good, type, package);
    CHECK(petsc::factor_fault(ksp).text == "");
    CHECK_FALSE(petsc::factor_fault(ksp).singular);
  }
  const petsc::KspHandle own = solved(bad, PCLU, MATSOLVERPETSC), mumps = solved(bad, PCLU, MATSOLVERMUMPS);
  CHECK(petsc::factor_fault(own).singular);
  CHECK_THAT(petsc::why_failed(own), Contains("ZEROPIVOT"));
  CHECK(petsc::factor_fault(mumps).singular);
  CHECK_THAT(petsc::why_failed(mumps), Contains("INFOG(1) = -10") && Contains("singular"));
}

TEST_CASE("a solver that has not factored yet has no fault") {
  const petsc::MatHandle A = diagonal(3);
  petsc::KspHandle ksp;
  PC pc = nullptr;
  check(KSPCreate(PETSC_COMM_SELF, ksp.out()));
  check(KSPSetOperators(ksp, A, A));
  check(KSPGetPC(ksp, &pc));
  check(PCSetType(pc, PCLU));
  check(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  CHECK(petsc::why_failed(ksp) == "");
}

TEST_CASE("an option that PETSc cannot take is the user's fault, with the option's prefix") {
  petsc::VecHandle vec;
  check(VecCreateSeq(PETSC_COMM_SELF, 3, vec.out()));
  CHECK_NOTHROW(petsc::check_options(0, "modes_"));
  CHECK_THROWS_AS(petsc::check_options(VecSetType(vec, "no such type"), "modes_"), InputError);
  CHECK_THROWS_WITH(petsc::check_options(VecSetType(vec, "no such type"), "modes_"),
                    Contains("-modes_...") && Contains("no such type"));
}

TEST_CASE("all ranks arrive where all of them come") { CHECK(petsc::all_arrive(PETSC_COMM_WORLD, 60)); }
