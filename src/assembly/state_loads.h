#pragma once
#include <functional>
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

/// Of the components of a load that depends on sensors (Load::formulas), which all its parts have in common.
using StateFormulas = std::vector<std::shared_ptr<dynamics::StateFormula>>;

/// What a load is of which `value` gives the components, as terms of its parts.
using UnitLoads =
    std::function<std::vector<std::unique_ptr<dynamics::Term>>(const std::function<Eigen::Vector3d(double)>& value)>;

/// The terms of a load that is not on a joint; where it depends on sensors, each of its components by the load of
/// size 1. @param formulas  on ranks that have parts of it
std::vector<std::unique_ptr<dynamics::Term>> terms_of_load(const Load& load, const StateFormulas& formulas,
                                                           const UnitLoads& unit);

/// Whether loads on elements, which are on all ranks at full order, depend on sensors.
bool has_spread_state_loads(const Scene& scene);

}  // namespace floe::assembly
