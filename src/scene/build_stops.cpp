#include "build_stops.h"

#include <cmath>

namespace floe::scene {

dynamics::StopLaw law_of(const LimitsSpec& limits, bool turn, double extent) {
  return {limits.lower, limits.upper, limits.stiffness, limits.damping,
          limits.width.value_or(turn ? 1e-3 : 1e-3 * extent)};
}

void note_stops(const Joint& joint, const LimitsSpec& limits, const dynamics::Stop* term, std::vector<ModelStop>& all) {
  if (std::isfinite(limits.lower)) all.push_back({joint.name, false, term});
  if (std::isfinite(limits.upper)) all.push_back({joint.name, true, term});
}

std::vector<double> stop_gaps(const Model& model, Vec U) {
  std::vector<double> gaps(model.stops.size());
  if (gaps.empty()) return gaps;
  Eigen::VectorXd q;
  model.system->gather(U, q);
  const MPI_Comm comm = model.system->comm();
  int rank = 0, size = 1;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &size);
  for (std::size_t i = 0; i < gaps.size() && rank == size - 1; ++i) {
    const dynamics::Stop& stop = *model.stops[i].term;
    const std::vector<int>& at = stop.coordinates();
    const Eigen::VectorXd own = q(at), none = Eigen::VectorXd::Zero(own.size());
    const double x = stop.position({0, own, none, none});
    gaps[i] = model.stops[i].upper ? stop.law().upper - x : x - stop.law().lower;
  }
  if (size > 1) MPI_Bcast(gaps.data(), static_cast<int>(gaps.size()), MPI_DOUBLE, size - 1, comm);
  return gaps;
}

}  // namespace floe::scene
