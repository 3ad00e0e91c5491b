#pragma once
#include <array>

#include "floe/reduction/modes.h"

namespace floe::reduction {

using Pairs = std::vector<std::array<int, 2>>;  ///< indices of generating fields from 0

/// (1,1) (1,2) ... (m,m), from 0. p = m (m + 1) / 2.
Pairs all_pairs(int m);

/// Static modal derivatives theta_ij = d phi_i / d eta_j, inertia neglected.
///
/// Solves K theta_ij = -(dK/deta_j) phi_i for the given pairs, all right-hand sides at once. The fields phi may be
/// modes or attachment modes. theta_ij = theta_ji.
/// @param fields  phi, in the floating frame
/// @return        theta, one for each pair, in the floating frame
/// Collective. No factorisation of its own, one block solve. Source: Idelsohn & Cardona 1985.
Columns static_derivatives(const fem::Structure& structure, const Statics& statics, const Columns& fields,
                           const Pairs& pairs);

/// Modal derivatives with inertia, Wu & Tiso's eq. 10:
///
///   (K - omega_i^2 M) theta_ij = -(dK/deta_j - domega_i^2/deta_j M) phi_i,   phi_i' M theta_ij = 0
///
/// Singular in the direction of phi_i: solved by Nelson's method (the dof where phi_i is maximum is fixed, and the part
/// along phi_i added by the orthogonality). Not symmetric: a pair (i, j) with i != j gives theta_ij and theta_ji.
/// @return  for each pair theta_ij, then for i != j theta_ji; `which` receives (i, j) of each
/// Collective. One factorisation for each distinct i; where round-off spoils it (Statics::refines), it preconditions
/// GMRES on the exact operator. Source: Nelson 1976, AIAA J. 14(9).
Columns full_derivatives(const fem::Structure& structure, const fem::ReferenceFrame& frame, const fem::Holding& holding,
                         const Statics& statics, const Modes& modes, const Pairs& pairs, Pairs& which);

}  // namespace floe::reduction
