#pragma once
#include "floe/reduction/projection.h"

namespace floe::reduction {

/// The mean over nodes of position, displacement and rotation: how a set of nodes moves as one place. Collective;
/// replicated.
/// @param nodes  global, at least one
body::PlaceMap place_map(const fem::Structure& structure, const Basis& basis, const std::vector<PetscInt>& nodes);

}  // namespace floe::reduction
