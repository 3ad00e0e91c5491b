#include "estimate_parts.h"

#include <fmt/format.h>

#include <cmath>

namespace floe::assess {

using Eigen::VectorXd;
using petsc::check;

std::string without_estimate(const Offline& offline) {
  if (std::none_of(offline.plan.bodies.begin(), offline.plan.bodies.end(), has_structure))
    return "no body has a mesh; bodies from files and rigid bodies have no full-order model to compare with";
  return "";
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
