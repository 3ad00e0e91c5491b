#pragma once
#include <functional>

#include "floe/dynamics/system.h"

namespace floe::solve {
using namespace dynamics;

/// How a path of equilibria is followed.
struct PathRequest {
  double first = 0.1;  ///< increment of t that no step exceeds, and that of the first one
  double end = 1;      ///< the path ends where t reaches it, from either side
  int most = 1000;     ///< or after so many points,
  int number = 0;      ///< of which these were found before
};

struct PathPoint {
  int number;  ///< from 1
  double t;    ///< of the loads
  /// t has a maximum or minimum along the path: here (at), or somewhere in the step to this point, where Newton's
  /// method failed beside it (within).
  enum class Limit { none, at, within } limit;
  bool last;  ///< t = end, or all requested points are found
};

struct PathEnd {
  int points = 0;  ///< with those found before
  PetscInt iterations = 0;
  bool at_end = false;  ///< t = end
  bool closed = false;  ///< it returned to one of its limit points; else it has all requested points
};

/// The path F(t(s), U(s), V, 0) = 0 from an equilibrium (t, U) on, past points where t has a maximum or a minimum
/// (snap-through) and displacements reverse (snap-back), by steps of arc length:
///
///   ds^2 = sum_i M_ii dU_i^2 + beta^2 dt^2,   beta = max_d |J^-1 (F(t + d) - F(t))| / d at the start
///
/// over increments d up to the end and dF/dt itself: a scale of displacements for loads that begin smoothly, too.
/// Predictor along the tangent (-J^-1 dF/dt, 1), corrected by Newton's method in the plane normal to it; both equations
/// are solved with one factor of J (prefix static_). The direction is that which continues the last step. A step is
/// halved where the corrector fails or goes further than half the step, and where the tangent rotates by more than
/// half a radian, or the chord differs from it at either end by more than a quarter (on another branch tangents may
/// agree, but not with the chord); down to 1e-4 of the length of the first one (the first itself to 1e-8 of the
/// requested increment); the shortest passes a kink of the path. Limit points are found to 1e-6 of the dt/ds at the
/// ends of their step.
///
/// The path passes bifurcations on its own branch, as long as its steps are longer than the arc that imperfections
/// round off there. Sources: Keller 1977; Crisfield 1981; Ramm 1981.
///
/// @param observe  called with every point and its U; attitudes begin each step at their bases
/// @throws RunError  no step converges; the message has t. Unconstrained: at the start. Collective.
PathEnd follow_path(const System& system, double t, const PathRequest& request, Vec U, Vec V,
                    const std::function<void(const PathPoint&, Vec U)>& observe);

}  // namespace floe::solve
