#pragma once
#include <string>

#include "floe/dynamics/system.h"

namespace floe::dynamics {

/// Names what a singular tangent leaves open: the bodies and joints (Coordinates::belongs_to) whose unknowns take part
/// in its null vectors, as ` (body arm, joint tip)`; empty where none was named or the system is too large to look.
///
/// The same on every rank. Collective. Gathers J where it has at most 1000 rows: O(n^3).
std::string undetermined(const System& system, Mat J);

}  // namespace floe::dynamics
