#pragma once
#include <cmath>
#include <string>

#include "floe/dynamics/system.h"

namespace floe::solve {
using namespace dynamics;

constexpr double rotation_limit = 1.2 * M_PI;  ///< of a body in one search [rad]

/// What came of Newton's method.
struct NewtonSearch {
  PetscInt iterations = 0;
  bool singular = false;  ///< it failed because a tangent has no inverse
  bool far = false;       ///< a step rotated by more than a right angle
  /// Why it failed; empty where it ended, or came no further: the next step tells what that is worth.
  std::string fault;
};

/// F(t, U, V, 0) = 0 from U by SNES, prefix static_, with full steps. It also ends where nothing but round-off is left
/// of any row (rows have units of their own, so that no norm of them all tells), and where ten steps gain nothing.
/// @param before  from where rotations count; @param J  is overwritten
/// @throws RunError  memory, or whatever else is no matter of the search. Collective.
NewtonSearch newton(const System& system, double t, Vec U, Vec V, Vec before, Mat J);

}  // namespace floe::solve
