#pragma once
#include "floe/assembly/offline.h"
#include "floe/solve/deviation.h"

namespace floe::assembly {

/// A state of the reduced model in the coordinates of one whose bodies have more columns, behind those they have;
/// multipliers of rows that the reduced model leaves out are zero. Rank-local.
solve::State lifted_to_more_columns(const solve::State& state, const Model& reduced, const Model& more);

/// A state of the reduced model as one of full order, q = V eta, in its vectors. Collective.
/// @param relieved  with the displacements over which energies are condensed, which the forces of V eta alone lack
void lift_to_full_order(const solve::State& state, const Model& reduced, const Offline& offline, const Model& full,
                        Vec U, Vec V, Vec A, bool relieved = false);

}  // namespace floe::assembly
