#include "floe/scene/joint_events.h"

#include <algorithm>

namespace floe::scene {

bool is_unlocked(const Scene& scene, const std::string& joint) {
  return std::any_of(scene.events.begin(), scene.events.end(),
                     [&](const Event& event) { return event.kind == Event::Kind::unlock && event.joint == joint; });
}

bool is_switched(const Scene& scene, const std::string& joint) {
  return std::any_of(scene.events.begin(), scene.events.end(),
                     [&](const Event& event) { return event.kind != Event::Kind::stop && event.joint == joint; });
}

bool is_measured(const Scene& scene, const std::string& joint) {
  if (joint.empty()) return false;
  const auto on_body = [&](const std::string& body) {
    return std::any_of(scene.joints.begin(), scene.joints.end(), [&](const Joint& one) {
      return one.name == joint && (one.first.body == body || one.second.body == body);
    });
  };
  return std::any_of(scene.probes.begin(), scene.probes.end(), [&](const Probe& probe) {
    return probe.of_section() ? on_body(probe.at.body) : probe.joint == joint;
  });
}

}  // namespace floe::scene
