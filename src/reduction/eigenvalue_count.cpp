#include "eigenvalue_count.h"

#include "floe/petsc/stage.h"
#include "floe/petsc/values.h"

namespace floe::reduction {

using petsc::check;

std::optional<PetscInt> eigenvalues_below(const fem::Structure& structure, const fem::Conditions& constrained,
                                          double bound) {
  const petsc::Stage stage("eigenvalue count");
  const petsc::MatHandle A = fem::assemble(structure, constrained, 1, 1, -bound);
  petsc::MatHandle factor;
  MatFactorInfo info;
  PetscInt negative = 0, zero = 0, fault = 0;
  check(MatGetFactor(A, MATSOLVERMUMPS, MAT_FACTOR_CHOLESKY, factor.out()));
  check(MatMumpsSetIcntl(factor, 13, 1));   // the last block by MUMPS, not ScaLAPACK, which does not count
  check(MatMumpsSetIcntl(factor, 14, 50));  // pivoting fills more than that of a definite matrix
  check(MatMumpsSetIcntl(factor, 24, 1));
  check(MatFactorInfoInitialize(&info));
  check(MatCholeskyFactorSymbolic(factor, A, nullptr, &info));
  check(MatCholeskyFactorNumeric(factor, A, &info));
  check(MatMumpsGetInfog(factor, 1, &fault));
  if (fault < 0) return std::nullopt;
  check(MatGetInertia(factor, &negative, &zero, nullptr));
  return negative;
}

}  // namespace floe::reduction
