#pragma once
#include <string>

#include "floe/dynamics/system.h"

namespace floe::solve {
using namespace dynamics;

/// What a singular tangent [K C'; C 0] leaves open: the bodies and joints (Coordinates::belongs_to) whose unknowns take
/// part in its null vectors, as ` (body arm, joint tip)`.
struct Undetermined {
  bool loose = false, repeated = false;  ///< null vectors among the coordinates, among the multipliers
  std::string bodies, joints;            ///< in them
  bool any() const { return loose || repeated; }
};

/// Whether unknowns are named, and not too many for null_vectors().
bool can_look(const System& system);

/// Nothing where it cannot look. The same on every rank. Collective. Gathers J
/// where it has at most 1000 rows: O(n^3).
Undetermined null_vectors(const System& system, Mat J);

/// The bodies that a step moves most, each coordinate in its own unit, as ` (body arm)`. Collective.
std::string names_of_movers(const System& system, Vec step);

/// Both names in one, for tangents whose null vectors are of one kind.
std::string undetermined(const System& system, Mat J);

}  // namespace floe::solve
