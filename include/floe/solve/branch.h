#pragma once
#include <functional>

#include "floe/dynamics/system.h"

namespace floe::solve {
using namespace dynamics;

/// Where equilibria do not continue from one load to the next: a snap, a load that jumps, or a search that came to
/// another branch.
struct BranchJump {
  double from = 0, to = 0;  ///< t, or speeds [rad/s]
  double ratio = 0;         ///< of the change over what the tangents at both ends predict
};

/// Whether a change d of a state, from one equilibrium to the next, is the branch's own: with the tangents at both ends
///
///   a = -J(t0, U0)^-1 F(t1, U0),   b = J(t1, U1)^-1 F(t0, U1):   d = (a + b)/2 + O(h^3) on a branch,
///
/// so that |d - (a + b)/2| <= |d|/2 once the step h is short, and both a and b point along d (weighted by masses);
/// where the state jumps, a and b vanish with h and d does not, and where it comes to the mirror image of its branch,
/// which is near beyond a critical load, a points away from d.
inline constexpr double most_departure = 0.5;
/// Of the change over the prediction: where a stop begins or ends to act within the shortest step it is at most 2.
inline constexpr double least_jump = 3;

/// From the equilibrium U at t to that at `next`, in halved steps down to `least` where a whole one finds none, or
/// comes to a state that does not continue the branch. Where the shortest one does not either, or where a shorter step
/// finds none, the whole step stands. Attitudes begin each step at their bases, and end there.
///
/// @param jumped  called with each jump, U before and after it (attitudes of both by the same bases)
/// @return iterations. @throws RunError  as equilibrium(). Collective.
PetscInt follow_equilibrium(const System& system, double t, double next, double least, Vec U, Vec V,
                            const std::function<void(const BranchJump&, Vec before, Vec after)>& jumped);

}  // namespace floe::solve
