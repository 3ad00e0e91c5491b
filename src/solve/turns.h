#pragma once
#include "floe/dynamics/system.h"

namespace floe::solve {
using namespace dynamics;

/// Greatest turn of an attitude or angle from one configuration to another with the same bases, as steps added up.
/// [rad] Collective.
double greatest_turn(const System& system, Vec from, Vec to);

/// Greatest turn of an attitude, or of an angle of the plane (Coordinates::angles), by a step. [rad] Collective.
double turn_by(const System& system, Vec step);

}  // namespace floe::solve
