#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "floe/scene/sensors.h"
#include "readers.h"

namespace floe::scene {
namespace {

using JointKind = Joint::Kind;

/// Whether a lock has rows to hold: in the plane hinges and slides, in space all that leave something free and whose
/// free motions are those of one place's axes.
bool lockable(JointKind kind, int dimension) {
  if (kind == JointKind::revolute || kind == JointKind::prismatic) return true;
  return dimension == 3 &&
         (kind == JointKind::cylindrical || kind == JointKind::spherical || kind == JointKind::planar);
}

void check_joint(Document& document, const Scene& scene, const Event& event) {
  Where where = event.where;
  where.key += event.kind == Event::Kind::lock ? ".lock" : ".unlock";
  std::vector<std::string> names;
  for (const Joint& joint : scene.joints) names.push_back(joint.name);
  const auto found = std::find(names.begin(), names.end(), event.joint);
  if (found == names.end()) {
    document.fault(where, "is \"" + event.joint + "\"", "the name of a joint", event.joint, names);
    return;
  }
  const JointKind kind = scene.joints[found - names.begin()].kind;
  if (kind == JointKind::support)
    document.fault(where, "is \"" + event.joint + "\", a support", "a joint of another type");
  else if (kind == JointKind::spring || kind == JointKind::bushing)
    document.fault(where, "is \"" + event.joint + "\", a spring", "a joint that constrains a motion");
  else if (event.kind == Event::Kind::lock && !lockable(kind, scene.dimension))
    document.fault(where, "is \"" + event.joint + "\", which leaves no motion free that could be locked",
                   scene.dimension == 3 ? "a revolute, prismatic, cylindrical, spherical or planar joint"
                                        : "a revolute or prismatic joint");
}

}  // namespace

Event read_event(Document& document, const std::string& name, const Value& value) {
  Event event;
  event.name = name;
  event.where = value.where;
  Reading reading(document, value, "event");
  if (!value.node.IsMap()) return event;
  const std::string what = reading.one_of({"unlock", "lock", "stop"});
  const std::string when = reading.one_of({"at", "when", "probe"});
  if (what == "unlock") event.kind = Event::Kind::unlock;
  if (what == "lock") event.kind = Event::Kind::lock;
  if (what == "unlock" || what == "lock") event.joint = reading.text(what);
  if (what == "stop" && !reading.flag("stop"))
    document.fault(reading.where("stop"), "is false", "true (or no such event)");
  if (when == "at") event.at = reading.number("at");
  if (when == "when") event.when = reading.formula("when");
  if (when == "probe") event.probe = reading.text("probe"), event.crosses = reading.number("crosses");
  if (when != "probe" && reading.given("crosses"))
    document.fault(reading.where("crosses"), "is given without probe", "probe: NAME.COMPONENT, as tip.y");
  return event;
}

void check_events(Document& document, const Scene& scene) {
  if (document.fault_count() > 0) return;
  std::vector<std::string> components;
  for (const Probe& probe : scene.probes)
    for (const std::string& component : components_of(probe.quantity, scene.dimension))
      components.push_back(probe.name + "." + component);
  for (const Event& event : scene.events) {
    if (event.kind != Event::Kind::stop) check_joint(document, scene, event);
    Where where = event.where;
    if (event.at && scene.motion.end > 0 && *event.at > scene.motion.end) {
      where.key += ".at";
      document.fault(where, fmt::format("is {}", *event.at), fmt::format("at most motion.end, {}", scene.motion.end));
    } else if (event.at && event.kind == Event::Kind::stop && *event.at <= 1e-12 * scene.motion.end) {
      where.key += ".at";
      document.fault(where, fmt::format("is {}", *event.at), "a time after the start");
    }
    if (event.probe.empty()) continue;
    where.key += ".probe";
    if (std::find(components.begin(), components.end(), event.probe) == components.end())
      document.fault(where, "is \"" + event.probe + "\"",
                     components.size() > 12 ? "a component of a probe, as " + components.front()
                                            : fmt::format("one of {}", fmt::join(components, ", ")),
                     event.probe, components);
  }
}

}  // namespace floe::scene
