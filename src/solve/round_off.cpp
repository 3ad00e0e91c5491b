#include "round_off.h"

#include <cmath>

#include "floe/petsc/error.h"
#include "floe/petsc/values.h"

namespace floe::solve {

using petsc::check;

petsc::VecHandle sizes_of_terms(Mat J, Vec x) {
  petsc::VecHandle all, sums;
  VecScatter to_all = nullptr;
  check(VecScatterCreateToAll(x, &to_all, all.out()));
  check(VecScatterBegin(to_all, x, all, INSERT_VALUES, SCATTER_FORWARD));
  check(VecScatterEnd(to_all, x, all, INSERT_VALUES, SCATTER_FORWARD));
  check(VecScatterDestroy(&to_all));
  check(VecDuplicate(x, sums.out()));
  petsc::Values values(all);
  petsc::Values own(sums);
  for (PetscInt i = own.first; i < own.end; ++i) {
    PetscInt n = 0;
    const PetscInt* columns = nullptr;
    const double* entries = nullptr;
    check(MatGetRow(J, i, &n, &columns, &entries));
    own[i] = 0;
    for (PetscInt k = 0; k < n; ++k) own[i] += std::abs(entries[k] * values[columns[k]]);
    check(MatRestoreRow(J, i, &n, &columns, &entries));
  }
  return sums;
}

bool is_round_off(Mat J, Vec x, Vec F, double several) {
  const petsc::VecHandle sizes = sizes_of_terms(J, x);
  int within = 1;
  {
    petsc::Values size(sizes), row(F);
    for (PetscInt i = row.first; i < row.end; ++i)
      if (!(std::abs(row[i]) <= several * PETSC_MACHINE_EPSILON * size[i])) within = 0;
  }
  MPI_Allreduce(MPI_IN_PLACE, &within, 1, MPI_INT, MPI_LAND, PetscObjectComm(reinterpret_cast<PetscObject>(J)));
  return within != 0;
}

double share_of(Mat J, Vec d, Vec x) {
  petsc::VecHandle diagonal;
  check(VecDuplicate(x, diagonal.out()));
  check(MatGetDiagonal(J, diagonal));
  double sums[2] = {0, 0};
  {
    petsc::Values weight(diagonal), part(d), whole(x);
    for (PetscInt i = weight.first; i < weight.end; ++i) {
      const double w = std::abs(weight[i]);
      sums[0] += w * part[i] * part[i], sums[1] += w * whole[i] * whole[i];
    }
  }
  MPI_Allreduce(MPI_IN_PLACE, sums, 2, MPI_DOUBLE, MPI_SUM, PetscObjectComm(reinterpret_cast<PetscObject>(J)));
  return sums[1] > 0 ? std::sqrt(sums[0] / sums[1]) : (sums[0] > 0 ? INFINITY : 0);
}

petsc::MatHandle copy_of_dense(Mat J) {
  petsc::MatHandle copy;
  PetscBool dense = PETSC_FALSE;
  check(PetscObjectTypeCompareAny(reinterpret_cast<PetscObject>(J), &dense, MATSEQDENSE, MATDENSE, ""));
  if (dense) check(MatDuplicate(J, MAT_COPY_VALUES, copy.out()));
  return copy;
}

}  // namespace floe::solve
