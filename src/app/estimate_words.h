#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "floe/assess/estimate.h"

namespace floe::app {

/// What the terminal says of an estimate, or why there is none: lines.
std::string estimate_words(const assess::Estimate& estimate);

/// Of an accuracy that was asked for and is not reached, with as many digits as tell the two apart.
std::string missed_words(double asked, double supported);

/// The same of the error of the step, as the summary has it (`estimate: {step: ...}`), of a motion to `end` [s].
std::string step_words(const nlohmann::ordered_json& step, double end);

}  // namespace floe::app
