#pragma once
#include "document.h"
#include "renamed_sensors.h"

namespace floe::scene {

/// Whether the copy of a group has the event, too: it unlocks or locks a joint that is copied, or a probe that is
/// copied triggers it.
bool is_of_group(const YAML::Node& event, const RenamedSensors& sensors);

/// The copy of such an event, with the copies of its joint and probe. A fault where the probe would switch a joint that
/// is not copied, and where the rotation makes a sum of several components of the probe's.
/// @param copy  the name of the copy
YAML::Node copied_event(Document& document, const std::string& name, const YAML::Node& event, const std::string& copy,
                        const RenamedSensors& sensors, const GroupMotion& motion);

}  // namespace floe::scene
