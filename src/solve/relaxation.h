#pragma once
#include <string>

#include "floe/dynamics/system.h"

namespace floe::solve {
using namespace dynamics;

/// What came of a relaxation.
struct Relaxation {
  PetscInt steps = 0;      ///< that were taken; none where the first cannot be solved for
  bool runs_away = false;  ///< the loads drive it on, by more with every step, or round and round
  /// So, and by four times as much as s is quartered, or by as much with every step of one s: no stiffness at all is on
  /// the way.
  bool freely = false;
  std::string bodies;  ///< that run away, as ` (body arm)`
};

/// U <- U - (K + s M)^-1 F, s = s_0, s_0/4, ... until it is nothing (pseudo-transient continuation; Kelley and Keyes
/// 1998): down to an equilibrium near the way that a damped motion would go. A step that rotates by more than a radian,
/// or along which K + s M is not positive, is not taken but s made greater; while steps rotate by more than a quarter
/// of one, s stays. Stops where the first step fails, or after one and a half turns.
///
/// With K n = 0 along the way and F'n constant, steps along n are F'n / (s n'Mn): each four times the one before.
/// Collective.
Relaxation relax(const System& system, double t, Vec U, Vec V);

}  // namespace floe::solve
