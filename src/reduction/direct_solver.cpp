#include <fmt/format.h>

#include "floe/petsc/factorisation.h"
#include "floe/petsc/stage.h"
#include "floe/reduction/statics.h"

namespace floe::reduction {

using petsc::check;

petsc::VecHandle copy(Vec vector) {
  petsc::VecHandle twin;
  check(VecDuplicate(vector, twin.out()));
  check(VecCopy(vector, twin));
  return twin;
}

namespace {

/// ICNTL(27), where MUMPS is still what factors.
void widen_blocks(KSP ksp) {
  PC pc = nullptr;
  PetscBool factors = PETSC_FALSE, mumps = PETSC_FALSE;
  MatSolverType type = nullptr;
  Mat factor = nullptr;
  check(KSPGetPC(ksp, &pc));
  check(PetscObjectTypeCompareAny(reinterpret_cast<PetscObject>(pc), &factors, PCCHOLESKY, PCLU, ""));
  if (!factors) return;
  check(PCFactorGetMatSolverType(pc, &type));
  check(PetscStrcmp(type, MATSOLVERMUMPS, &mumps));
  if (!mumps) return;
  check(PCFactorSetUpMatSolverType(pc));
  check(PCFactorGetMatrix(pc, &factor));
  check(MatMumpsSetIcntl(factor, 27, 64));
}

}  // namespace

petsc::KspHandle direct_solver(Mat A, const char* prefix) {
  petsc::KspHandle ksp;
  PC pc = nullptr;
  check(KSPCreate(PetscObjectComm(reinterpret_cast<PetscObject>(A)), ksp.out()));
  check(KSPSetOptionsPrefix(ksp, prefix));
  check(KSPSetOperators(ksp, A, A));
  check(KSPSetType(ksp, KSPPREONLY));
  check(KSPSetTolerances(ksp, 1e-10, PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT));  // of an iteration, by options
  check(KSPGetPC(ksp, &pc));
  check(PCSetType(pc, PCCHOLESKY));
  check(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  petsc::check_options(KSPSetFromOptions(ksp), prefix);
  PetscBool whole = PETSC_FALSE;
  check(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(pc), PCLU, &whole));
  if (whole)
    throw InputError(
        fmt::format("option -{}pc_type lu: the matrix is symmetric, and one triangle of it is stored; expected "
                    "cholesky",
                    prefix));
  widen_blocks(ksp);
  return ksp;
}

void iterate(KSP ksp, KSPType type) {
  check(KSPSetType(ksp, type));
  check(KSPSetNormType(ksp, KSP_NORM_PRECONDITIONED));
  check(KSPSetTolerances(ksp, 1e-12, PETSC_DEFAULT, PETSC_DEFAULT, 30));
}

petsc::MatHandle dense_like(Vec column, std::size_t count) {
  PetscInt local = 0, global = 0;
  petsc::MatHandle dense;
  check(VecGetLocalSize(column, &local));
  check(VecGetSize(column, &global));
  check(MatCreateDense(PetscObjectComm(reinterpret_cast<PetscObject>(column)), local, PETSC_DECIDE, global,
                       static_cast<PetscInt>(count), nullptr, dense.out()));
  check(MatAssemblyBegin(dense, MAT_FINAL_ASSEMBLY));
  check(MatAssemblyEnd(dense, MAT_FINAL_ASSEMBLY));
  return dense;
}

petsc::MatHandle dense_of(const Columns& columns) {
  petsc::MatHandle dense = dense_like(columns[0], columns.size());
  for (std::size_t j = 0; j < columns.size(); ++j) {
    Vec column = nullptr;
    check(MatDenseGetColumnVecWrite(dense, static_cast<PetscInt>(j), &column));
    check(VecCopy(columns[j], column));
    check(MatDenseRestoreColumnVecWrite(dense, static_cast<PetscInt>(j), &column));
  }
  return dense;
}

Columns columns_of(Mat dense) {
  PetscInt count = 0;
  Columns columns;
  check(MatGetSize(dense, nullptr, &count));
  for (PetscInt j = 0; j < count; ++j) {
    Vec column = nullptr;
    check(MatDenseGetColumnVecRead(dense, j, &column));
    columns.emplace_back();
    check(VecCreate(PetscObjectComm(reinterpret_cast<PetscObject>(dense)), columns.back().out()));
    PetscInt local = 0, global = 0;
    check(VecGetLocalSize(column, &local));
    check(VecGetSize(column, &global));
    check(VecSetSizes(columns.back(), local, global));
    check(VecSetType(columns.back(), VECSTANDARD));
    check(VecCopy(column, columns.back()));
    check(MatDenseRestoreColumnVecRead(dense, j, &column));
  }
  return columns;
}

namespace {

void check_converged(KSP ksp) {
  KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
  check(KSPGetConvergedReason(ksp, &reason));
  if (reason >= 0) return;
  if (const std::string why = petsc::why_failed(ksp); !why.empty()) throw RunError(why);
  const char* prefix = nullptr;
  check(KSPGetOptionsPrefix(ksp, &prefix));
  throw RunError(fmt::format("a linear solve (options -{}ksp_...) did not converge: {}", prefix ? prefix : "",
                             KSPConvergedReasons[reason]));
}

/// KSPMatSolve would tell how the last column went only.
void solve_columns(KSP ksp, Mat B, Mat X, PetscInt count) {
  for (PetscInt j = 0; j < count; ++j) {
    Vec b = nullptr, x = nullptr;
    check(MatDenseGetColumnVecRead(B, j, &b));
    check(MatDenseGetColumnVecWrite(X, j, &x));
    const PetscErrorCode code = KSPSolve(ksp, b, x);
    check(MatDenseRestoreColumnVecWrite(X, j, &x));
    check(MatDenseRestoreColumnVecRead(B, j, &b));
    check(code);
    check_converged(ksp);
  }
}

}  // namespace

void block_solve(KSP ksp, Mat B, Mat X) {
  const petsc::Stage stage("block solves");
  PetscInt count = 0;
  PetscBool direct = PETSC_FALSE;
  check(MatGetSize(B, nullptr, &count));
  check(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(ksp), KSPPREONLY, &direct));
  if (!direct) return solve_columns(ksp, B, X, count);
  check(KSPMatSolve(ksp, B, X));
  check_converged(ksp);
}

Columns block_solve(KSP ksp, const Columns& B) {
  if (B.empty()) return {};
  const petsc::MatHandle X = dense_like(B[0], B.size());
  block_solve(ksp, dense_of(B), X);
  return columns_of(X);
}

}  // namespace floe::reduction
