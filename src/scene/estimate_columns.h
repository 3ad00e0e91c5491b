#pragma once
#include "offline.h"

namespace floe::scene {

/// Columns that carry most of what loads f do to a body, u_i = K^-1 P' f_i: at most `most`, the eigenvectors of the
/// work u_i'f_j of the snapshots (proper orthogonal decomposition in the norm of K). Those below 1e-4 of the greatest
/// norm are left out. Collective. One block solve.
reduction::Columns response_columns(const reduction::Statics& statics, const reduction::Columns& loads, int most);

/// The body on [V W]: its first coordinates are those that it has. Rayleigh damping acts on all, modal damping on the
/// first. Collective.
ReducedBody with_columns(const PreparedBody& body, const ReducedBody& reduced, const reduction::Columns& W);

}  // namespace floe::scene
