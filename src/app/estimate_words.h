#pragma once
#include <string>

#include "floe/assess/estimate.h"

namespace floe::app {

/// What the terminal says of an estimate, or why there is none: lines.
std::string estimate_words(const assess::Estimate& estimate, bool has_total = false);

/// Of an accuracy that was asked for and is not reached, with as many digits as distinguish the two.
std::string missed_words(double asked, double supported);

}  // namespace floe::app
