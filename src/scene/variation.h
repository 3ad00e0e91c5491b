#pragma once
#include "document.h"
#include "floe/scene/variation.h"

namespace floe::scene {

/// Puts the numbers in their places. @throws InputError  a line for each path that is not there or is no number
void vary(const YAML::Node& root, const std::string& file, const std::vector<Variation>& variations);

}  // namespace floe::scene
