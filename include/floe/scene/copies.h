#pragma once
namespace YAML {
class Node;
}

namespace floe::scene {

struct Scene;

/// The text of a scene that has been read without faults, with the keys that copies (`like: NAME`) have of others in
/// their places, and copies of groups written out: for writing another scene from it.
YAML::Node load_resolved(const Scene& scene);

}  // namespace floe::scene
