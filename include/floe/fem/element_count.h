#pragma once
#include "floe/fem/mesh.h"

namespace floe::fem {

/// Number of elements of all ranks: beams, shells and point masses, not springs. Collective.
PetscInt element_count(const Mesh& mesh);

}  // namespace floe::fem
