#include <algorithm>
#include <cmath>

#include "floe/petsc/values.h"
#include "floe/reduction/modes.h"

namespace floe::reduction {

using petsc::check;

namespace {

/// Of the first translation, by original numbers, that is above half the greatest one. Collective.
double sign_of(const fem::Structure& structure, Vec shape) {
  petsc::Values values(shape);
  const int n = structure.dofs_per_node;
  const auto translation = [&](PetscInt i) { return i % n < structure.dimension(); };
  double greatest = 0;
  for (PetscInt i = 0; i < values.end - values.first; ++i)
    if (translation(i)) greatest = std::max(greatest, std::abs(values[values.first + i]));
  MPI_Allreduce(MPI_IN_PLACE, &greatest, 1, MPI_DOUBLE, MPI_MAX, structure.mesh.comm);
  struct {
    double sign;
    PetscInt where;
  } first{0, PETSC_MAX_INT};
  for (PetscInt i = 0; i < values.end - values.first; ++i) {
    const PetscInt dof = structure.original_dof(static_cast<int>(i));
    const double value = values[values.first + i];
    if (translation(i) && dof < first.where && std::abs(value) > 0.5 * greatest) first = {value < 0 ? -1.0 : 1.0, dof};
  }
  PetscInt lowest = first.where;
  MPI_Allreduce(MPI_IN_PLACE, &lowest, 1, MPIU_INT, MPI_MIN, structure.mesh.comm);
  double sign = first.where == lowest ? first.sign : 0;
  MPI_Allreduce(MPI_IN_PLACE, &sign, 1, MPI_DOUBLE, MPI_SUM, structure.mesh.comm);
  return sign;
}

}  // namespace

void fix_sign(const fem::Structure& structure, Vec shape) {
  if (sign_of(structure, shape) < 0) check(VecScale(shape, -1));
}

}  // namespace floe::reduction
