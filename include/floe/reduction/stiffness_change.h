#pragma once
#include <functional>

#include "floe/reduction/statics.h"

namespace floe::reduction {

/// y = A x of a symmetric A, for x in the floating frame.
using Operator = std::function<void(Vec x, Vec y)>;

/// What an additional stiffness A changes of the stiffness D of a body.
struct StiffnessChange {
  /// With mu the stationary values of phi'A phi / phi'D phi, of which the minimum and the maximum count if they are
  /// below and above 0:
  ///
  ///   (1 + mu_min) (1 + mu_max) - 1
  ///
  /// Where A stiffens or softens one shape this is mu; where it couples two shapes and changes neither by itself
  /// (mu = +-c: bending with torsion), it is what it changes of one while the other follows statically, -c^2.
  ///
  /// Where D is not positive but D + A is: 1 less what D is of D + A, > 1. Where neither is, K stands for D.
  double relative = 0;
  Columns shapes;  ///< where the two values are taken
};

/// By Lanczos' method on K^-1 A in the inner product of K, from a load that depends on the mesh alone: to 0.1 % of the
/// maximum value or at most 24 solves with K, then Rayleigh-Ritz in that space with D = K + `more`.
///
/// @throws RunError  not converged: a solve. Collective.
StiffnessChange stiffness_change(const fem::Structure& structure, const Statics& statics, const Operator& A,
                                 const Operator& more);

}  // namespace floe::reduction
