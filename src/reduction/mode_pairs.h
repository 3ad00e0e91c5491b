#pragma once
#include <slepceps.h>

#include <optional>

#include "mode_quality.h"

namespace floe::reduction {

/// A rough field that depends on the dofs' original numbers only, not on ranks, zero at the conditions: the start of
/// the Krylov space, or one of them. Collective.
petsc::VecHandle rough_field(const fem::Structure& structure, const fem::Conditions& conditions, int number = 0);

/// Where pairs K phi = lambda M phi are looked for.
struct PairSearch {
  EPS eps = nullptr;  ///< set up but for what changes from one solve to the next: dimensions, initial space, deflation
  const fem::Structure& structure;
  const fem::Conditions& constrained;
  const Columns& rigid;  ///< motions of a body that is free, which are deflated
  const Statics& statics;
  int available;        ///< how many pairs there are
  bool lowest = true;   ///< of lambda, which the user's options may change
  bool errors = false;  ///< whether Found.error is wanted
};

/// The linear solver of its transformation.
KSP solver_of(EPS eps);

/// How many vectors the EPS's space has for `count` pairs: three more than SLEPc's default, each of which makes the
/// last pair's residual ten times smaller or more, so that no restart is needed (nine solves for a mode more). Other
/// solvers choose themselves.
PetscInt subspace_of(EPS eps, PetscInt count, PetscInt available);

/// How many of the pairs have the frequency of the last one counted, but come after it.
int left_out(const std::vector<double>& lambda, int count);

/// The `count` lowest pairs and all more that have the last one's lambda, ascending; where the user's options choose
/// others, those.
///
/// Krylov methods may pass over pairs where more frequencies are close together than there are vectors in a block.
/// Wherever that can be, or is cheap to see, the negative pivots of K - s M with s behind the last pair tell how many
/// there are below (Sylvester's law of inertia); what is missing is then looked for with those found deflated, from
/// other vectors. Where nothing is factored, such a search itself tells.
/// @throws RunError    the EPS did not converge, or does not find what the pivots tell of; not where some found lie so
///                     near to s that round-off of the factor may count them on either side
/// @throws InputError  the user's EPS finds rigid motions that it should deflate; far more pairs than `count` have the
///                     last one's lambda
/// Collective.
/// @param M  of the rigid motions
Found lowest_pairs(const PairSearch& search, Mat M, int count);

}  // namespace floe::reduction
