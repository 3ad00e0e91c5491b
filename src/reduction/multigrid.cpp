#include "multigrid.h"

#include <vector>

#include "floe/reduction/statics.h"

namespace floe::reduction {

using petsc::check;

bool factors(KSP ksp) {
  PC pc = nullptr;
  PetscBool direct = PETSC_FALSE;
  check(KSPGetPC(ksp, &pc));
  check(
      PetscObjectTypeCompareAny(reinterpret_cast<PetscObject>(pc), &direct, PCCHOLESKY, PCLU, PCREDUNDANT, PCSVD, ""));
  return direct;
}

namespace {

/// The rigid motions with what is constrained taken out, orthonormal; those that nothing is left of are left out.
Columns orthonormal_rigid(const fem::ReferenceFrame& frame, const fem::Conditions& constrained) {
  Columns rigid;
  for (const petsc::VecHandle& motion : frame.rigid) {
    petsc::VecHandle x = copy(motion);
    fem::hold(x, constrained);
    double before = 0, after = 0;
    check(VecNorm(x, NORM_2, &before));
    for (int twice = 0; twice < 2; ++twice)
      for (const petsc::VecHandle& other : rigid) {
        double along = 0;
        check(VecDot(x, other, &along));
        check(VecAXPY(x, -along, other));
      }
    check(VecNormalize(x, &after));
    if (after > 1e-10 * before) rigid.push_back(std::move(x));
  }
  return rigid;
}

}  // namespace

void set_near_null_space(Mat A, const fem::ReferenceFrame& frame, const fem::Conditions& constrained) {
  const Columns rigid = orthonormal_rigid(frame, constrained);
  const std::vector<Vec> vectors(rigid.begin(), rigid.end());
  MatNullSpace near = nullptr;
  check(MatNullSpaceCreate(PetscObjectComm(reinterpret_cast<PetscObject>(A)), PETSC_FALSE,
                           static_cast<PetscInt>(vectors.size()), vectors.data(), &near));
  const PetscErrorCode code = MatSetNearNullSpace(A, near);
  check(MatNullSpaceDestroy(&near));
  check(code);
}

petsc::MatHandle for_multigrid(Mat A, const fem::ReferenceFrame& frame, const fem::Conditions& constrained) {
  petsc::MatHandle rows;
  check(MatConvert(A, MATAIJ, MAT_INITIAL_MATRIX, rows.out()));
  check(MatSetOption(rows, MAT_SPD, PETSC_TRUE));
  set_near_null_space(rows, frame, constrained);
  return rows;
}

}  // namespace floe::reduction
