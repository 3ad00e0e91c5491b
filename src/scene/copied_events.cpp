#include "copied_events.h"

#include <fmt/format.h>

namespace floe::scene {
namespace {

std::string scalar(const YAML::Node& event, const char* key) {
  return event[key] && event[key].IsScalar() ? event[key].Scalar() : "";
}

std::string joint_of(const YAML::Node& event) {
  const std::string unlocked = scalar(event, "unlock");
  return unlocked.empty() ? scalar(event, "lock") : unlocked;
}

}  // namespace

bool is_of_group(const YAML::Node& event, const RenamedSensors& sensors) {
  return event.IsMap() && (sensors.joints.count(joint_of(event)) > 0 || sensors.has_probe(scalar(event, "probe")));
}

YAML::Node copied_event(Document& document, const std::string& name, const YAML::Node& event, const std::string& copy,
                        const RenamedSensors& sensors, const GroupMotion& motion) {
  const std::string prefix = copy + "_", joint = joint_of(event), probe = scalar(event, "probe");
  const std::string otherwise = fmt::format(
      "an entry {0}{1} beside {1}, which replaces its copy; or {1} in copies.{2}.without", prefix, name, copy);
  const auto refuse = [&](const char* key, const std::string& wrong, const std::string& expected) {
    document.fault(document.place_of(event[key].Mark(), fmt::format("events.{}.{}", name, key)), wrong, expected);
    return event;
  };
  if (!joint.empty() && !sensors.joints.count(joint))
    return refuse("probe", fmt::format("is \"{}\", of the group of copies.{}, and joint {} is not", probe, copy, joint),
                  otherwise);
  const auto crossing = sensors.crossing({probe, event["crosses"] ? scalar(event, "crosses") : "0"}, prefix, motion);
  if (!crossing)
    return refuse(
        "probe",
        fmt::format("is \"{}\", which is the sum of several components after the rotation of copies.{}", probe, copy),
        "a rotation by right angles, " + otherwise);
  YAML::Node copied = empty_map_at(event);
  for (const auto& entry : event) {
    const std::string key = entry.first.IsScalar() ? entry.first.Scalar() : "";
    if (key == "unlock" || key == "lock")
      copied.force_insert(entry.first, text_at(entry.second, prefix + joint));
    else if (key == "probe" && !probe.empty())
      copied.force_insert(entry.first, text_at(entry.second, crossing->probe));
    else if (key != "crosses" || probe.empty())
      copied.force_insert(entry.first, entry.second);
  }
  if (!probe.empty() && (event["crosses"] || crossing->crosses != "0"))
    copied.force_insert("crosses", text_at(event["crosses"] ? event["crosses"] : event["probe"], crossing->crosses));
  return copied;
}

}  // namespace floe::scene
