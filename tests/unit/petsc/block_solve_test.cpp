#include <petscksp.h>
#include <petscsf.h>

#include <algorithm>
#include <catch2/catch.hpp>

#include "floe/petsc/error.h"
#include "floe/petsc/factorisation.h"
#include "floe/petsc/handle.h"

using namespace floe;
using petsc::check;

namespace {

/// Springs between neighbours on a grid of n by n, constrained by `ground` at each; the last rank may have no row.
petsc::MatHandle springs(PetscInt n, double ground, PetscInt own) {
  petsc::MatHandle A;
  check(MatCreate(PETSC_COMM_WORLD, A.out()));
  check(MatSetSizes(A, own, own, n * n, n * n));
  check(MatSetType(A, MATSBAIJ));
  check(MatSetUp(A));
  PetscInt first = 0, end = 0;
  check(MatGetOwnershipRange(A, &first, &end));
  for (PetscInt i = first; i < end; ++i) {
    check(MatSetValue(A, i, i, 4 + ground, INSERT_VALUES));
    if ((i + 1) % n != 0) check(MatSetValue(A, i, i + 1, -1, INSERT_VALUES));
    if (i + n < n * n) check(MatSetValue(A, i, i + n, -1, INSERT_VALUES));
  }
  check(MatAssemblyBegin(A, MAT_FINAL_ASSEMBLY));
  check(MatAssemblyEnd(A, MAT_FINAL_ASSEMBLY));
  return A;
}

petsc::KspHandle solver(Mat A) {
  petsc::KspHandle ksp;
  PC pc = nullptr;
  check(KSPCreate(PETSC_COMM_WORLD, ksp.out()));
  check(KSPSetOptionsPrefix(ksp, "blocks_"));
  check(KSPSetOperators(ksp, A, A));
  check(KSPSetType(ksp, KSPPREONLY));
  check(KSPGetPC(ksp, &pc));
  check(PCSetType(pc, PCCHOLESKY));
  check(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  check(KSPSetFromOptions(ksp));
  return ksp;
}

/// @param gap  between the columns in memory
petsc::MatHandle dense(Mat A, PetscInt columns, PetscInt gap) {
  PetscInt local = 0, all = 0;
  petsc::MatHandle B;
  check(MatGetLocalSize(A, &local, nullptr));
  check(MatGetSize(A, &all, nullptr));
  check(MatCreate(PETSC_COMM_WORLD, B.out()));
  check(MatSetSizes(B, local, PETSC_DECIDE, all, columns));
  check(MatSetType(B, MATDENSE));
  check(MatDenseSetLDA(B, local + gap));
  check(MatSetUp(B));
  check(MatSetRandom(B, nullptr));
  return B;
}

/// The greatest difference of X's columns from solutions one by one, which PETSc's own MatSolve finds.
double apart(KSP ksp, Mat A, PetscInt columns, PetscInt gap = 0) {
  const petsc::MatHandle B = dense(A, columns, gap), X = dense(A, columns, 2 * gap);
  petsc::VecHandle b, x;
  check(KSPMatSolve(ksp, B, X));
  check(MatCreateVecs(A, x.out(), b.out()));
  double greatest = 0;
  for (PetscInt j = 0; j < columns; ++j) {
    double difference = 0, size = 0;
    check(MatGetColumnVector(B, b, j));
    check(KSPSolve(ksp, b, x));
    check(VecNorm(x, NORM_INFINITY, &size));
    check(MatGetColumnVector(X, b, j));
    check(VecAXPY(b, -1, x));
    check(VecNorm(b, NORM_INFINITY, &difference));
    greatest = std::max(greatest, difference / size);
  }
  return greatest;
}

/// Of the events that PETSc has counted: scatters made.
int made() {
  PetscLogEvent event = 0;
  PetscEventPerfInfo info;
  check(PetscSFInitializePackage());  // else nobody knows the event before the first scatter
  check(PetscLogEventGetId("SFSetGraph", &event));
  check(PetscLogEventGetPerfInfo(PETSC_DETERMINE, event, &info));
  return info.count;
}

}  // namespace

TEST_CASE("Blocks of solutions are those that come one by one, through one scatter", "[parallel]") {
  petsc::prepare_mumps();
  check(PetscLogDefaultBegin());
  PetscMPIInt rank = 0, ranks = 1;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  MPI_Comm_size(PETSC_COMM_WORLD, &ranks);
  constexpr PetscInt n = 23;
  for (const bool empty : {false, true}) {
    const PetscInt others = n * n / ranks, last = n * n - others * (ranks - 1);
    const PetscInt own = !empty || ranks == 1 ? PETSC_DECIDE
                         : rank == ranks - 1  ? 0
                         : rank == 0          ? others + last
                                              : others;
    const petsc::MatHandle A = springs(n, 0.5, own);
    const petsc::KspHandle ksp = solver(A);
    CHECK(apart(ksp, A, 5) < 1e-12);
    const int before = made();
    CHECK(apart(ksp, A, 1) < 1e-12);
    CHECK(apart(ksp, A, 64) < 1e-12);
    CHECK(apart(ksp, A, 130) < 1e-12);
    if (ranks > 1) CHECK(apart(ksp, A, 70, 3) < 1e-12);  // of PETSc's own, one rank's takes dense columns only
    CHECK(made() == before);

    const petsc::MatHandle other = springs(n, 3, own);  // the same solver with other numbers
    check(MatCopy(other, A, SAME_NONZERO_PATTERN));
    check(KSPSetOperators(ksp, A, A));
    CHECK(apart(ksp, A, 7) < 1e-12);
  }
}

TEST_CASE("Options that ask for PETSc's own way get it", "[parallel]") {
  petsc::prepare_mumps();
  check(PetscOptionsSetValue(nullptr, "-blocks_mat_mumps_icntl_20", "0"));
  const petsc::MatHandle A = springs(17, 0.5, PETSC_DECIDE);
  const petsc::KspHandle ksp = solver(A);
  check(PetscLogDefaultBegin());
  PetscMPIInt ranks = 1;
  MPI_Comm_size(PETSC_COMM_WORLD, &ranks);
  CHECK(apart(ksp, A, 70) < 1e-12);
  const int before = made();
  CHECK(apart(ksp, A, 7) < 1e-12);
  CHECK((made() > before) == (ranks > 1));  // it makes the scatter anew
  check(PetscOptionsClearValue(nullptr, "-blocks_mat_mumps_icntl_20"));
}
