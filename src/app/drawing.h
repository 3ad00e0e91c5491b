#pragma once
#include <string>

namespace floe::app {

/// Draws FOLDER/NAME.png with the script NAME.py that is shipped. Returns the picture's path, or says why there is
/// none.
std::string draw(const std::string& name, const std::string& folder);

}  // namespace floe::app
