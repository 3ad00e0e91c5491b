#pragma once
#include <string>

namespace YAML {
class Node;
}

namespace floe::scene {

/// The text of a scene that has been read without faults, with the keys that copies (`like: NAME`) have of others in
/// their places: for those who write another scene from it.
YAML::Node load_resolved(const std::string& text);

}  // namespace floe::scene
