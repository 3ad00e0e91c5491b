#pragma once
#include <petscmat.h>

#include <vector>

namespace floe::solve {

/// LU factorisation of a small dense matrix by LAPACK, for solves that take less than the calls of PC and Mat around
/// them.
class DenseFactor {
 public:
  /// Factors J (MATSEQDENSE) where it is not the matrix that was factored last, or has changed since.
  /// @param found  false: a pivot is zero
  PetscErrorCode factor(Mat J, PetscBool* found);
  /// y = J^-1 b.
  PetscErrorCode solve(Vec b, Vec y) const;

 private:
  PetscObjectId of_ = 0;
  PetscObjectState state_ = -1;
  bool found_ = false;
  PetscBLASInt n_ = 0;
  std::vector<double> LU_, reciprocals_;  // of the diagonal of U
  std::vector<PetscBLASInt> rows_;        // row i was exchanged with row rows[i], counted from 1
};

}  // namespace floe::solve
