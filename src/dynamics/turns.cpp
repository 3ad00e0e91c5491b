#include "turns.h"

#include <algorithm>
#include <cmath>

namespace floe::dynamics {

double greatest_turn(const System& system, Vec from, Vec to) {
  Eigen::VectorXd before, after;
  system.gather(from, before), system.gather(to, after);
  double greatest = 0;
  for (const auto& attitude : system.attitudes())
    greatest = std::max(greatest, (after - before).segment<3>(attitude.first).norm());
  return greatest;
}

double turn_by(const System& system, Vec step) {
  Eigen::VectorXd by;
  system.gather(step, by);
  double greatest = by.allFinite() ? 0 : INFINITY;
  for (const auto& attitude : system.attitudes()) greatest = std::max(greatest, by.segment<3>(attitude.first).norm());
  for (const Coordinates::Angle& angle : system.coordinates().angles())
    greatest = std::max(greatest, std::abs(by[angle.local]));
  MPI_Allreduce(MPI_IN_PLACE, &greatest, 1, MPI_DOUBLE, MPI_MAX, system.comm());
  return greatest;
}

}  // namespace floe::dynamics
