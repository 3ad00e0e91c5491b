#pragma once
#include <string>

#include "floe/scene/estimate.h"

namespace floe::app {

/// What the terminal says of an estimate, or why there is none: lines.
std::string estimate_words(const scene::Estimate& estimate);

}  // namespace floe::app
