#pragma once
#include "floe/fem/mesh.h"

namespace floe::fem {

/// Number of elements of all ranks: beams and shells, not point masses and springs. Collective.
PetscInt element_count(const Mesh& mesh);

}  // namespace floe::fem
