#pragma once
#include <optional>
#include <string>
#include <vector>

#include "floe/plan/prepare.h"

namespace floe::plan {

/// A place's name in the file of its body: its own, or `at(1, 0, 0)`.
std::string name_in_file(const Place& place, int dimension);

/// What constrained the modes of a meshed body, `revolute about z at left`, `interface at tip`; nothing: they are those
/// of the body in its frame alone (modes: {of: frame}).
std::optional<std::vector<std::string>> held_by_modes(const Plan& plan, int body);

/// A line on a body from a file that joints hold otherwise than its modes; empty where they do not, or where the file
/// does not contain what held them. Joints to other bodies count where the frame is clamped, as in held_at_frame.
std::string held_otherwise(const Plan& plan, int body);

}  // namespace floe::plan
