#pragma once
#include <string>

namespace floe::app {

/// Draws a folder's results with a script that is shipped (`compare`, `sweep`). Returns the picture's path, or says why
/// there is none. Rank-local.
std::string draw(const std::string& folder, const std::string& script);

}  // namespace floe::app
