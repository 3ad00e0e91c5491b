#include "floe/assembly/rotation.h"

#include <fmt/format.h>

#include <cmath>

#include "drive.h"
#include "planar_assembly.h"

namespace floe::assembly {

using Kind = Joint::Kind;

namespace {

bool rotations(const Joint& joint) {
  return (joint.kind == Kind::driven || joint.kind == Kind::revolute) && joint.first.ground() != joint.second.ground();
}

const Anchor& place_of(const Plan& plan, std::size_t j) {
  const auto& [first, second] = plan.joints[j];
  return first.ground() ? second : first;
}

/// Where the hub's place is at the start, undeformed.
Eigen::Vector3d point_of(const Plan& plan, std::size_t j) {
  for (const Anchor& place : plan.joints[j])
    if (place.ground() && !std::isnan(place.x.x())) return place.x;
  const Anchor& place = place_of(plan, j);
  const PlannedBody& body = plan.bodies[place.body];
  if (plan.scene.dimension == 3)
    return body.place + body.attitude * (place.map ? Eigen::Vector3d(place.map->x) : place.x);
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d x = place.x;
  if (place.map) x.head<2>() = place.map->x;
  point.head<2>() = undeformed_place(body, x);
  return point;
}

/// Of the second place against the first, about the joint's axis.
double speed_of(const Plan& plan, std::size_t j, const Eigen::Vector3d& direction) {
  const Joint& joint = plan.scene.joints[j];
  if (joint.kind == Kind::driven) return drive_of(joint, plan.scene.motion).rate(0) * (joint.first.ground() ? 1 : -1);
  const Point& w = plan.bodies[place_of(plan, j).body].spec.initial.angular_velocity;
  return direction.dot(Eigen::Vector3d::Map(w.data()));
}

/// Initial angular velocities are those of the steady rotation, or not given.
void refuse_other_speeds(const Plan& plan, const solve::RotationAxis& axis, double speed, const std::string& where) {
  for (const PlannedBody& body : plan.bodies) {
    const Eigen::Vector3d w = Eigen::Vector3d::Map(body.spec.initial.angular_velocity.data());
    if (w.isZero(0) || (w - speed * axis.direction).norm() <= 1e-9 * std::abs(speed)) continue;
    throw InputError(
        fmt::format("{}: is steady_rotation at {:.6g} rad/s, and body {} has another initial angular_velocity; "
                    "expected that of the rotation, or none",
                    where, speed, body.spec.name));
  }
}

}  // namespace

const Joint* hub_of(const Scene& scene) {
  const Joint* hub = nullptr;
  for (const Joint& joint : scene.joints) {
    if (!rotations(joint)) continue;
    if (hub) return nullptr;
    hub = &joint;
  }
  return hub;
}

solve::RotatingSystem rotating_system(const Scene& scene, const Model& model, const solve::RotationAxis& axis) {
  solve::RotatingSystem rotating{*model.system, {}, axis, {}};
  for (const BodyReport& body : model.bodies) {
    const bool of_nodes = model.formulation == Formulation::cfr && body.first_dof >= 0;
    if (of_nodes) continue;  // every node is a frame among the system's attitudes
    if (body.first_coordinate < 0)
      throw InputError(
          fmt::format("{}: body {} is clamped to the ground, and cannot rotate; expected a joint of type "
                      "driven or revolute to the ground in place of a fixed one",
                      scene.file, body.name));
    if (!body.attitude) rotating.planar_frames.push_back(body.first_coordinate);
  }
  for (const Joint& joint : scene.joints)
    if (rotations(joint) && joint.kind == Kind::driven) rotating.drives.push_back("joint " + joint.name);
  for (const Joint& joint : scene.joints)
    if ((joint.kind == Kind::spring || joint.kind == Kind::bushing) && joint.first.ground() != joint.second.ground())
      rotating.springs.push_back((joint.kind == Kind::spring ? "spring " : "bushing ") + joint.name);
  return rotating;
}

std::vector<std::string> drives_beside_rotation(const Scene& scene) {
  std::vector<std::string> warnings;
  for (const Joint& joint : scene.joints) {
    if (!is_drive(joint.kind) || rotations(joint)) continue;
    const double rate = drive_of(joint, scene.motion).rate(0);
    if (rate == 0) continue;
    warnings.push_back(
        fmt::format("joint {} moves at {:.4g} {} at t = 0, and is at rest in the steady rotation: its velocity and its "
                    "gyroscopic moments are not part of it",
                    joint.name, rate, joint.kind == Kind::driven ? "rad/s" : "m/s"));
  }
  return warnings;
}

void start_in_rotation(const Plan& plan, Model& model) {
  const std::string where = plan.scene.motion.where.text() + ".start";
  const Joint* hub = hub_of(plan.scene);
  if (!hub)
    throw InputError(where + ": is steady_rotation; expected exactly one driven or revolute joint to the ground");
  if (model.formulation == Formulation::cfr && plan.scene.dimension == 2)
    throw InputError(where +
                     ": is steady_rotation, which formulation cfr has in space only; expected another formulation");
  const auto j = static_cast<std::size_t>(hub - plan.scene.joints.data());
  solve::RotationAxis axis;
  axis.point = point_of(plan, j);
  if (plan.scene.dimension == 3) axis.direction = plan.joint_axes[j].col(2);
  const double speed = speed_of(plan, j, axis.direction);
  if (speed == 0)
    throw InputError(
        fmt::format("{}: is steady_rotation, but joint {} does not rotate at t = 0; expected a drive with a "
                    "speed there, or an initial angular_velocity of the body at the hinge",
                    where, hub->name));
  refuse_other_speeds(plan, axis, speed, where);
  const solve::RotatingSystem rotating = rotating_system(plan.scene, model, axis);
  solve::RotationSearch search;
  try {
    solve::check_rotations(rotating, model.U);
    solve::steady_rotation(rotating, 0, speed, model.U, &search);
  } catch (const InputError& error) {
    throw InputError(where + ": " + error.what());
  } catch (const RunError& error) {
    throw RunError(where + ": " + error.what());
  }
  for (std::string& warning : drives_beside_rotation(plan.scene)) model.warnings.push_back(std::move(warning));
  if (const std::string words = solve::other_rotation(search); !words.empty())
    model.warnings.push_back(where + ": " + words);
  if (const solve::BranchJump& jump = search.jump; jump.ratio > 0)
    model.warnings.push_back(
        fmt::format("{}: between {:.6g} and {:.6g} rad/s the steady rotation jumps to another branch: the change is "
                    "{:.2g} times that predicted by the tangents (limit {:.2g}). The simulation starts on the other "
                    "branch; for the intended one give a start (`start: given`, `initial`)",
                    where, jump.from, jump.to, jump.ratio, solve::least_jump));
  solve::rotating_velocities(rotating, speed, model.U, model.V);
}

}  // namespace floe::assembly
