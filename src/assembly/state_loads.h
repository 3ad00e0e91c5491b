#pragma once
#include <memory>

#include "floe/dynamics/joint_force.h"
#include "floe/dynamics/state_force.h"
#include "floe/scene/sensors.h"

namespace floe::assembly {
using namespace scene;

dynamics::RelativeCoordinate::Of of_dynamics(JointCoordinate of);

/// A force of size 1 that increases a joint's coordinate. @param active  null, or whether the joint is: else no force
std::unique_ptr<dynamics::Term> unit_load(std::unique_ptr<dynamics::RelativeCoordinate> of,
                                          std::shared_ptr<const dynamics::ConstraintSwitch> active);

}  // namespace floe::assembly
