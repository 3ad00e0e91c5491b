#pragma once
#include "floe/assembly/model.h"

namespace floe::assembly {

/// @param turn   radians, else metres
/// @param extent a length of the scene
dynamics::StopLaw law_of(const LimitsSpec& limits, bool turn, double extent);

dynamics::FrictionLaw law_of(const FrictionSpec& friction);

/// Notes the stops of a joint. @param term  null where another rank has it
void note_stops(const Joint& joint, const LimitsSpec& limits, const dynamics::Stop* term, std::vector<ModelStop>& all);

}  // namespace floe::assembly
