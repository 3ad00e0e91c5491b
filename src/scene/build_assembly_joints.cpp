#include <fmt/format.h>

#include <cmath>

#include "build_assembly.h"
#include "floe/petsc/values.h"

namespace floe::scene {

using dynamics::Marker;

void Assembly::add_joints(const Eigen::VectorXd& q) {
  std::vector<std::array<Marker, 2>> markers;  // finding them is collective, what follows is rank-local
  for (const auto& joint : prepared_.joints) markers.push_back({marker(joint[0]), marker(joint[1])});
  const auto add = [&] {
    for (std::size_t j = 0; owner_ && j < markers.size(); ++j) add_joint(j, markers[j], q);
  };
  if (is_reduced(formulation_))
    add();
  else
    petsc::agree(prepared_.comm, add);
}

void Assembly::add_joint(std::size_t j, std::array<Marker, 2>& places, const Eigen::VectorXd& q) {
  const Joint& joint = prepared_.scene.joints[j];
  for (int i = 0; i < 2; ++i)  // a ground without a point follows the other place
    if (prepared_.joints[j][i].body < 0 && std::isnan(places[i].x.x()))
      places[i].x = pose_at(places[1 - i], q).head<2>();
  const Eigen::Vector3d y[2] = {pose_at(places[0], q), pose_at(places[1], q)};
  const Eigen::Vector2d apart = (y[1] - y[0]).head<2>();
  const double offset = y[1][2] - y[0][2];
  const int multipliers = joint_multipliers_[j];
  const bool meet = joint.kind != Joint::Kind::spring && joint.kind != Joint::Kind::prismatic;
  if (meet && apart.norm() > 1e-6 * prepared_.extent)
    throw InputError(
        fmt::format("{}: the two places of joint {} are {:.6g} apart at the start, at ({:.6g}, {:.6g}) and "
                    "({:.6g}, {:.6g}); expected the same point",
                    joint.where.text(), joint.name, apart.norm(), y[0][0], y[0][1], y[1][0], y[1][1]));
  const auto found = latches_.find(joint.name);
  const JointLatches latches = found == latches_.end() ? JointLatches{} : found->second;
  switch (joint.kind) {
    case Joint::Kind::revolute:
      terms_.push_back(std::make_unique<dynamics::Joint>(places[0], places[1], dynamics::Revolute{}, multipliers,
                                                         joint_rows_[j], latches.joint));
      if (latches.lock)
        terms_.push_back(std::make_unique<dynamics::Joint>(places[0], places[1], dynamics::Clamp{}, latches.first_row,
                                                           std::vector<int>{2}, latches.lock, true));
      break;
    case Joint::Kind::fixed:
      terms_.push_back(std::make_unique<dynamics::Joint>(places[0], places[1], dynamics::Clamp{offset, {}}, multipliers,
                                                         joint_rows_[j], latches.joint));
      break;
    case Joint::Kind::driven: {
      const math::Formula angle = joint.angle;
      if (std::abs(angle(0)) > 1e-9)
        throw InputError(
            fmt::format("{}: the driven angle is {:.6g} at t = 0; expected 0, because it is measured from the "
                        "start",
                        joint.where.text(), angle(0)));
      const dynamics::TimeFunction f{[angle](double t) { return angle(t); },
                                     [angle](double t) { return angle.derivative(t); },
                                     [angle](double t) { return angle.second_derivative(t); }};
      terms_.push_back(std::make_unique<dynamics::Joint>(places[0], places[1], dynamics::Clamp{offset, f}, multipliers,
                                                         joint_rows_[j], latches.joint));
      break;
    }
    case Joint::Kind::prismatic: {
      const Eigen::Vector2d axis = Eigen::Vector2d(joint.axis[0], joint.axis[1]).normalized();
      const Eigen::Vector2d normal(-axis.y(), axis.x());
      const dynamics::Prismatic slide{turn(-y[0][2]) * normal, normal.dot(apart), offset};
      terms_.push_back(
          std::make_unique<dynamics::Joint>(places[0], places[1], slide, multipliers, joint_rows_[j], latches.joint));
      if (latches.lock)
        terms_.push_back(std::make_unique<dynamics::Joint>(places[0], places[1],
                                                           dynamics::Prismatic{turn(-y[0][2]) * axis, 0, 0},
                                                           latches.first_row, std::vector<int>{0}, latches.lock, true));
      break;
    }
    case Joint::Kind::spring:
      terms_.push_back(std::make_unique<dynamics::Spring>(
          places[0], places[1],
          dynamics::SpringProperties{joint.stiffness, joint.viscosity, joint.length.value_or(apart.norm()),
                                     joint.torsional_stiffness, joint.torsional_viscosity, offset}));
      break;
  }
}

}  // namespace floe::scene
