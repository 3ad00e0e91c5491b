#include "dense_factor.h"

#include <petsc/private/petscimpl.h>
#include <petscblaslapack.h>

#include <algorithm>
#include <utility>

#include "floe/math/clones.h"

namespace floe::solve {
namespace {

// x <- U^-1 L^-1 x, L with ones on its diagonal, by columns.
FLOE_CLONES void substitute(const double* LU, const double* reciprocals, PetscBLASInt n, double* x) {
  for (PetscBLASInt j = 0; j < n; ++j) {
    const double* column = LU + static_cast<std::size_t>(j) * n;
    const double factor = x[j];
    for (PetscBLASInt i = j + 1; i < n; ++i) x[i] -= factor * column[i];
  }
  for (PetscBLASInt j = n - 1; j >= 0; --j) {
    const double* column = LU + static_cast<std::size_t>(j) * n;
    const double factor = x[j] *= reciprocals[j];
    for (PetscBLASInt i = 0; i < j; ++i) x[i] -= factor * column[i];
  }
}

}  // namespace

PetscErrorCode DenseFactor::factor(Mat J, PetscBool* found) {
  PetscObjectId id;
  PetscObjectState state;
  PetscInt n, lead;
  PetscBLASInt info = 0;
  const PetscScalar* entries;

  PetscFunctionBegin;
  PetscCall(PetscObjectGetId((PetscObject)J, &id));
  PetscCall(PetscObjectStateGet((PetscObject)J, &state));
  if (id != of_ || state != state_) {
    PetscCall(MatGetSize(J, &n, nullptr));
    PetscCall(MatDenseGetLDA(J, &lead));
    PetscCall(PetscBLASIntCast(n, &n_));
    LU_.resize(static_cast<std::size_t>(n) * n), rows_.resize(n), reciprocals_.resize(n);
    PetscCall(MatDenseGetArrayRead(J, &entries));
    for (PetscInt j = 0; j < n; ++j) std::copy_n(entries + j * lead, n, LU_.data() + j * n);
    PetscCall(MatDenseRestoreArrayRead(J, &entries));
    PetscCallBLAS("LAPACKgetrf", LAPACKgetrf_(&n_, &n_, LU_.data(), &n_, rows_.data(), &info));
    for (PetscInt i = 0; i < n; ++i) reciprocals_[i] = 1 / LU_[i * (n + 1)];
    of_ = id, state_ = state, found_ = info == 0;
  }
  *found = found_ ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}

PetscErrorCode DenseFactor::solve(Vec b, Vec y) const {
  const PetscScalar* from;
  PetscScalar* x;

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(b, &from));
  PetscCall(VecGetArrayWrite(y, &x));
  std::copy_n(from, n_, x);
  for (PetscBLASInt i = 0; i < n_; ++i)
    if (rows_[i] != i + 1) std::swap(x[i], x[rows_[i] - 1]);
  substitute(LU_.data(), reciprocals_.data(), n_, x);
  PetscCall(VecRestoreArrayWrite(y, &x));
  PetscCall(VecRestoreArrayRead(b, &from));
  PetscFunctionReturn(0);
}

}  // namespace floe::solve
