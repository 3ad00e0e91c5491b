#include "estimate_parts.h"

#include <fmt/format.h>

#include <cmath>

#include "error_part.h"

namespace floe::assess {

using Eigen::VectorXd;
using petsc::check;

std::string without_estimate(const Offline& offline) {
  const std::string none = without_mesh(offline.plan.scene);
  return none.ends_with("mesh") ? none + "; bodies from files have no full-order model to compare with" : none;
}

std::vector<double> known(std::vector<double> errors) {
  for (double& error : errors) error = known(error);
  return errors;
}

double round_off_of(const Offline& offline) {
  double mass = 0;
  for (const ReducedBody& reduced : offline.reduced) mass += reduced.body.inertia.m;
  return mass * std::pow(64 * PETSC_MACHINE_EPSILON * offline.plan.extent, 2);
}

void note_files(const Offline& offline, Estimate& estimate) {
  for (const PlannedBody& body : offline.plan.bodies)
    if (body.spec.reduced)
      estimate.notes.push_back(fmt::format(
          "body {} comes from a file without its mesh; its reduction error is not included", body.spec.name));
}

}  // namespace floe::assess
