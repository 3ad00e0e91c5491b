#pragma once
#include "floe/dynamics/system.h"

namespace floe::solve {
using namespace dynamics;

/// Greatest rotation of an attitude or angle from one configuration to another with the same bases, as steps added up.
/// [rad] Collective.
double max_rotation(const System& system, Vec from, Vec to);

/// Greatest rotation of an attitude, or of an angle of the plane (Coordinates::angles), by a step. [rad] Collective.
double max_rotation_of_step(const System& system, Vec step);

}  // namespace floe::solve
