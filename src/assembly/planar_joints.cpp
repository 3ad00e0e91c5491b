#include <fmt/format.h>

#include <cmath>

#include "connections.h"
#include "drive.h"
#include "floe/petsc/values.h"
#include "planar_assembly.h"
#include "start_shape.h"
#include "stops.h"

namespace floe::assembly {

using dynamics::Marker;

void PlanarAssembly::add_joints(Model& model, const Eigen::VectorXd& q) {
  // Finding them is collective, what follows is rank-local.
  for (const auto& joint : plan_.joints) {
    auto& places = joint_places_.emplace_back(std::array{marker(joint[0]), marker(joint[1])});
    for (int i = 0; i < 2 && sees_; ++i)  // a ground without a point follows the other place
      if (joint[i].body < 0 && std::isnan(places[i].x.x())) places[i].x = pose_at(places[1 - i], q).head<2>();
  }
  const auto add = [&] {
    for (std::size_t j = 0; j < joint_places_.size(); ++j) {
      if (owner_) add_joint(j, joint_places_[j], q);
      add_stops(j, joint_places_[j], q, model.stops);
    }
  };
  if (is_reduced(formulation_))
    add();
  else
    petsc::agree(plan_.comm, add);
}

void PlanarAssembly::connect(std::size_t j, std::unique_ptr<dynamics::Connection> term) {
  connections_[j].push_back(term.get());
  terms_.push_back(std::move(term));
}

void PlanarAssembly::add_joint(std::size_t j, const std::array<Marker, 2>& places, const Eigen::VectorXd& q) {
  const Joint& joint = plan_.scene.joints[j];
  const Eigen::Vector3d y[2] = {pose_at(places[0], q), pose_at(places[1], q)};
  const Eigen::Vector2d apart = (y[1] - y[0]).head<2>();
  const double offset = y[1][2] - y[0][2];
  const bool meet = joint.kind != Joint::Kind::spring && joint.kind != Joint::Kind::prismatic;
  if (meet && apart.norm() > 1e-6 * plan_.extent)
    throw InputError(
        fmt::format("{}: the two places of joint {} are {:.6g} apart at the start, at ({:.6g}, {:.6g}) and "
                    "({:.6g}, {:.6g}); expected {}",
                    joint.where.text(), joint.name, apart.norm(), y[0][0], y[0][1], y[1][0], y[1][1],
                    expected_to_meet(plan_, formulation_, j)));
  const auto found = switches_.find(joint.name);
  const JointSwitches switches = found == switches_.end() ? JointSwitches{} : found->second;
  const auto constrain = [&](const dynamics::Constraint& constraint) {
    auto term = std::make_unique<dynamics::Joint>(places[0], places[1], constraint, joint_multipliers_[j],
                                                  joint_rows_[j], switches.joint);
    if (plan_.extent > 0) term->extent = plan_.extent;
    connect(j, std::move(term));
  };
  switch (joint.kind) {
    case Joint::Kind::revolute:
      constrain(dynamics::Revolute{});
      if (switches.lock)
        connect(j, std::make_unique<dynamics::Joint>(places[0], places[1], dynamics::Clamp{}, switches.first_row,
                                                     std::vector<int>{2}, switches.lock, true));
      break;
    case Joint::Kind::fixed:
      constrain(dynamics::Clamp{offset, {}});
      break;
    case Joint::Kind::driven:
      constrain(dynamics::Clamp{offset, drive_of(joint, plan_.scene.motion)});
      break;
    case Joint::Kind::prismatic: {
      const Eigen::Vector2d axis = Eigen::Vector2d(joint.axis[0], joint.axis[1]).normalized();
      const Eigen::Vector2d normal(-axis.y(), axis.x());
      constrain(dynamics::Prismatic{rotation_matrix(-y[0][2]) * normal, normal.dot(apart), offset});
      if (switches.lock)
        connect(j, std::make_unique<dynamics::Joint>(places[0], places[1],
                                                     dynamics::Prismatic{rotation_matrix(-y[0][2]) * axis, 0, 0},
                                                     switches.first_row, std::vector<int>{0}, switches.lock, true));
      break;
    }
    case Joint::Kind::spring:
      connect(j, std::make_unique<dynamics::Spring>(
                     places[0], places[1],
                     dynamics::SpringProperties{
                         joint.stiffness, joint.viscosity, relaxed_length(joint, apart.norm(), plan_.extent),
                         joint.torsional_stiffness, joint.torsional_viscosity, offset + joint.rest_angle}));
      break;
    default:  // those of space
      break;
  }
}

std::unique_ptr<dynamics::PlanarCoordinate> PlanarAssembly::coordinate_of(std::size_t j, Of of,
                                                                          const std::array<Marker, 2>& places,
                                                                          const Eigen::VectorXd& q) const {
  const Joint& joint = plan_.scene.joints[j];
  const Eigen::Vector3d one = pose_at(places[0], q), two = pose_at(places[1], q);
  const Eigen::Vector2d axis = Eigen::Vector2d(joint.axis[0], joint.axis[1]).normalized();
  const double start = of == Of::rotation ? two[2] - one[2] : of == Of::slide ? axis.dot((two - one).head<2>()) : 0;
  return std::make_unique<dynamics::PlanarCoordinate>(places[0], places[1], of, start, rotation_matrix(-one[2]) * axis);
}

void PlanarAssembly::add_stops(std::size_t j, const std::array<Marker, 2>& places, const Eigen::VectorXd& q,
                               std::vector<ModelStop>& stops) {
  const Joint& joint = plan_.scene.joints[j];
  const bool slides = joint.kind == Joint::Kind::prismatic;
  if (joint.friction && owner_)
    connect(j, std::make_unique<dynamics::JointForce>(coordinate_of(j, slides ? Of::slide : Of::rotation, places, q),
                                                      law_of(*joint.friction), own_switch(switches_, joint.name)));
  if (!joint.limits) return;
  const dynamics::Stop* term = nullptr;
  if (owner_) {
    auto stop = std::make_unique<dynamics::Stop>(coordinate_of(j, slides ? Of::slide : Of::rotation, places, q),
                                                 law_of(*joint.limits, !slides, plan_.extent),
                                                 own_switch(switches_, joint.name));
    term = stop.get();
    connect(j, std::move(stop));
  }
  note_stops(joint, *joint.limits, term, stops);
}

}  // namespace floe::assembly
