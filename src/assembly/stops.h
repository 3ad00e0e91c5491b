#pragma once
#include "floe/assembly/model.h"

namespace floe::assembly {

/// @param rotation  radians, else metres
/// @param extent a length of the scene
dynamics::StopLaw law_of(const LimitsSpec& limits, bool rotation, double extent);

dynamics::FrictionLaw law_of(const FrictionSpec& friction);

/// What states whether a joint's own constraints are active; none: no event unlocks it.
std::shared_ptr<const dynamics::ConstraintSwitch> own_switch(const std::map<std::string, JointSwitches>& all,
                                                             const std::string& joint);

/// Notes the stops of a joint. @param term  null where another rank has it
void note_stops(const Joint& joint, const LimitsSpec& limits, const dynamics::Stop* term, std::vector<ModelStop>& all);

}  // namespace floe::assembly
