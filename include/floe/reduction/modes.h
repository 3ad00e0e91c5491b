#pragma once
#include "floe/reduction/statics.h"

namespace floe::reduction {

/// Vibration modes of a body under conditions, mass-normalised: K phi = omega^2 M phi.
struct Modes {
  std::vector<double> omega;     ///< [rad/s], ascending
  std::vector<double> residual;  ///< |K phi - omega^2 M phi| / |omega^2 M phi|
  Columns raw;                   ///< phi as the body is held in space
  Columns shapes;                ///< phi in the floating frame, P phi
};

/// Lowest modes of the body as `holding.held` holds it; rigid motions that are left free are deflated, not counted.
///
/// EPS prefix modes_ (default: Krylov-Schur, shift-invert at 0, or just below it for bodies that can still move
/// rigidly, Cholesky by MUMPS). The sign of each mode makes the first translation above half the greatest one positive.
/// @param statics  a solver of the same body (estimates the shift of a free body)
/// @throws InputError  more modes asked than dofs; RunError  EPS did not converge. Collective.
Modes vibration_modes(const fem::Structure& structure, const fem::ReferenceFrame& frame, const fem::Holding& holding,
                      const Statics& statics, int count);

/// Flips a field's sign by the rule above. Collective.
void fix_sign(Vec shape);

}  // namespace floe::reduction
