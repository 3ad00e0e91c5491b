#pragma once
#include "floe/fem/structure.h"

namespace floe::fem {

/// separate() for beams in the plane that all lie on one line: along the line, or across it with the rotations.
/// Collective.
void separate_straight(const Structure& structure, Vec field, double share);

}  // namespace floe::fem
