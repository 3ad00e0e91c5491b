#include "floe/reduction/statics.h"

#include <fmt/format.h>

namespace floe::reduction {

using petsc::check;

petsc::VecHandle copy(Vec vector) {
  petsc::VecHandle twin;
  check(VecDuplicate(vector, twin.out()));
  check(VecCopy(vector, twin));
  return twin;
}

petsc::KspHandle direct_solver(Mat A, const char* prefix) {
  petsc::KspHandle ksp;
  PC pc = nullptr;
  check(KSPCreate(PetscObjectComm(reinterpret_cast<PetscObject>(A)), ksp.out()));
  check(KSPSetOptionsPrefix(ksp, prefix));
  check(KSPSetOperators(ksp, A, A));
  check(KSPSetType(ksp, KSPPREONLY));
  check(KSPGetPC(ksp, &pc));
  check(PCSetType(pc, PCCHOLESKY));
  check(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  petsc::check_options(KSPSetFromOptions(ksp), prefix);
  return ksp;
}

Columns block_solve(KSP ksp, const Columns& B) {
  Columns X;
  if (B.empty()) return X;
  PetscInt local = 0, global = 0;
  check(VecGetLocalSize(B[0], &local));
  check(VecGetSize(B[0], &global));
  const PetscInt count = static_cast<PetscInt>(B.size());
  petsc::MatHandle right, left;
  const MPI_Comm comm = PetscObjectComm(reinterpret_cast<PetscObject>(ksp));
  check(MatCreateDense(comm, local, PETSC_DECIDE, global, count, nullptr, right.out()));
  check(MatCreateDense(comm, local, PETSC_DECIDE, global, count, nullptr, left.out()));
  for (PetscInt j = 0; j < count; ++j) {
    Vec column = nullptr;
    check(MatDenseGetColumnVecWrite(right, j, &column));
    check(VecCopy(B[j], column));
    check(MatDenseRestoreColumnVecWrite(right, j, &column));
  }
  check(MatAssemblyBegin(right, MAT_FINAL_ASSEMBLY));
  check(MatAssemblyEnd(right, MAT_FINAL_ASSEMBLY));
  check(MatAssemblyBegin(left, MAT_FINAL_ASSEMBLY));
  check(MatAssemblyEnd(left, MAT_FINAL_ASSEMBLY));
  check(KSPMatSolve(ksp, right, left));
  KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
  check(KSPGetConvergedReason(ksp, &reason));
  if (reason < 0) {
    const char* prefix = nullptr;
    check(KSPGetOptionsPrefix(ksp, &prefix));
    throw RunError(fmt::format("a linear solve (options -{}ksp_...) did not converge: {}", prefix ? prefix : "",
                               KSPConvergedReasons[reason]));
  }
  for (PetscInt j = 0; j < count; ++j) {
    X.push_back(copy(B[j]));
    Vec column = nullptr;
    check(MatDenseGetColumnVecRead(left, j, &column));
    check(VecCopy(column, X.back()));
    check(MatDenseRestoreColumnVecRead(left, j, &column));
  }
  return X;
}

Statics::Statics(const fem::Structure& structure, const fem::ReferenceFrame& frame, const fem::Holding& holding)
    : frame_(frame),
      conditions_(holding.statics),
      K_(fem::stiffness(structure, holding.statics)),
      ksp_(direct_solver(K_, "derivatives_")) {}

Columns Statics::solve(const Columns& loads) const {
  Columns balanced;
  for (const auto& load : loads) {
    balanced.push_back(copy(load));
    fem::balance(frame_, balanced.back());
    fem::hold(balanced.back(), conditions_);
  }
  Columns u = block_solve(ksp_, balanced);
  for (const auto& column : u) fem::to_frame(frame_, column);
  return u;
}

}  // namespace floe::reduction
