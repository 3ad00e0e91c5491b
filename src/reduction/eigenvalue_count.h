#pragma once
#include <optional>

#include "floe/fem/assembly.h"

namespace floe::reduction {

/// How many eigenvalues of K q = lambda M q under conditions lie below `bound`, rigid motions (0) included: the
/// negative pivots of K - bound M = L D L' (Sylvester's law of inertia), factored by MUMPS. Nothing where MUMPS fails.
/// Collective. Time and memory: one more factorisation.
std::optional<PetscInt> eigenvalues_below(const fem::Structure& structure, const fem::Conditions& constrained,
                                          double bound);

}  // namespace floe::reduction
