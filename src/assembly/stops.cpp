#include "stops.h"

#include <cmath>

namespace floe::assembly {

dynamics::StopLaw law_of(const LimitsSpec& limits, bool rotation, double extent) {
  return {limits.lower, limits.upper, limits.stiffness, limits.damping,
          limits.width.value_or(rotation ? 1e-3 : 1e-3 * extent)};
}

dynamics::FrictionLaw law_of(const FrictionSpec& friction) {
  return {friction.level, friction.viscosity, friction.speed};
}

std::shared_ptr<const dynamics::ConstraintSwitch> own_switch(const std::map<std::string, JointSwitches>& all,
                                                             const std::string& joint) {
  const auto found = all.find(joint);
  return found == all.end() ? nullptr : found->second.joint;
}

void note_stops(const Joint& joint, const LimitsSpec& limits, const dynamics::Stop* term, std::vector<ModelStop>& all) {
  if (std::isfinite(limits.lower)) all.push_back({joint.name, false, term});
  if (std::isfinite(limits.upper)) all.push_back({joint.name, true, term});
}

std::array<double, 2> stop_gap(const Model& model, std::size_t i, double t, Vec U, Vec V) {
  std::array<double, 2> gap{};
  Eigen::VectorXd q, v;
  model.system->gather(U, q), model.system->gather(V, v);
  const MPI_Comm comm = model.system->comm();
  int rank = 0, size = 1;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &size);
  if (rank == size - 1) gap = {1, 0};  // of a joint that is released: never hit
  if (rank == size - 1 && model.stops[i].term->is_active()) {
    const dynamics::Stop& stop = *model.stops[i].term;
    const Eigen::VectorXd own = q(stop.coordinates()), rates = v(stop.coordinates()),
                          none = Eigen::VectorXd::Zero(own.size());
    const dynamics::Motion motion{t, own, rates, none};
    const auto [x, rate] = stop.at(motion);
    gap = model.stops[i].upper ? std::array{stop.law().upper - x, -rate} : std::array{x - stop.law().lower, rate};
  }
  if (size > 1) MPI_Bcast(gap.data(), 2, MPI_DOUBLE, size - 1, comm);
  return gap;
}

std::vector<double> stop_gaps(const Model& model, double t, Vec U) {
  std::vector<double> gaps;
  for (std::size_t i = 0; i < model.stops.size(); ++i) gaps.push_back(stop_gap(model, i, t, U, U)[0]);
  return gaps;
}

}  // namespace floe::assembly
