#include "rotations.h"

#include <algorithm>
#include <cmath>

#include "floe/petsc/error.h"

namespace floe::solve {

double max_rotation(const System& system, Vec from, Vec to) {
  const petsc::VecHandle by = system.create_vector();
  petsc::check(VecWAXPY(by, -1, from, to));
  return max_rotation_of_step(system, by);
}

double max_rotation_of_step(const System& system, Vec step) {
  Eigen::VectorXd by;
  system.gather(step, by);
  double greatest = by.allFinite() ? 0 : INFINITY;
  for (const auto& attitude : system.attitudes()) greatest = std::max(greatest, by.segment<3>(attitude.first).norm());
  for (const Coordinates::Angle& angle : system.coordinates().angles())
    greatest = std::max(greatest, std::abs(by[angle.local]));
  MPI_Allreduce(MPI_IN_PLACE, &greatest, 1, MPI_DOUBLE, MPI_MAX, system.comm());
  return greatest;
}

}  // namespace floe::solve
