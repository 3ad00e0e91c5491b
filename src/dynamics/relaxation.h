#pragma once
#include <string>

#include "floe/dynamics/system.h"

namespace floe::dynamics {

/// What came of a relaxation.
struct Relaxation {
  PetscInt steps = 0;
  bool runs_away = false;  ///< the loads drive it on, by more with every step
  bool freely = false;     ///< so, and by four times as much as s is quartered: no stiffness at all is on the way
  std::string bodies;      ///< that run away, as ` (body arm)`
};

/// U <- U - (K + s M)^-1 F, s = s_0, s_0/4, ... until it is nothing (pseudo-transient continuation; Kelley and Keyes
/// 1998). Stops where a step fails, or turns by more than once round: what stress holds is found before, and a
/// configuration so far away tells no more of what is loose.
///
/// With K n = 0 along the way and F'n constant, steps along n are F'n / (s n'Mn): each four times the one before.
/// Collective.
Relaxation relax(const System& system, double t, Vec U, Vec V);

}  // namespace floe::dynamics
