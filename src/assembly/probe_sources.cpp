#include "probe_sources.h"

#include <fmt/format.h>

#include "floe/assembly/body_stage.h"
#include "floe/error.h"
#include "floe/scene/sensors.h"

namespace floe::assembly {

std::vector<const dynamics::Term*> terms_of_body(const std::vector<std::vector<const dynamics::Term*>>& of_bodies,
                                                 const Plan& plan, const std::string& name) {
  std::vector<const dynamics::Term*> terms;
  for (std::size_t b = 0; b < of_bodies.size() && !name.empty(); ++b)
    if (whole_name(plan.bodies[b].spec) == name) terms.insert(terms.end(), of_bodies[b].begin(), of_bodies[b].end());
  return terms;
}

DrivenCoordinate driven_coordinate(const Plan& plan, std::size_t j, const Probe& probe) {
  const Joint& joint = plan.scene.joints[j];
  DrivenCoordinate drive;
  const std::vector<JointCoordinate> all = coordinates_of(joint, plan.scene.dimension);
  if (all.empty()) {
    if (probe.quantity == Probe::Quantity::power) return drive;
    throw InputError(
        fmt::format("{}.joint: joint {} has no coordinate that a drive acts on; expected a driven, revolute, "
                    "prismatic or cylindrical joint or a spring, or quantity: force or moment",
                    probe.where.text(), joint.name));
  }
  const bool tension = joint.stiffness != 0 || joint.viscosity != 0 || joint.preload != 0,
             torsion = joint.torsional_stiffness != 0 || joint.torsional_viscosity != 0,
             rotation = all.back() == JointCoordinate::rotation;
  drive.length = all.front() == JointCoordinate::length && (tension || !torsion || !rotation);
  drive.rotation = rotation && !drive.length;
  if (plan.scene.dimension == 3)
    drive.axis = plan.joint_axes[j].col(2);
  else if (!drive.rotation)
    drive.axis << Eigen::Vector2d(joint.axis[0], joint.axis[1]).normalized(), 0;
  return drive;
}

}  // namespace floe::assembly
