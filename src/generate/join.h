#pragma once
#include "floe/generate/generate.h"

namespace floe::generate {

/// Of the second mesh's share: the node of the first that each one coincides with in a seam, or -1. Collective.
/// @throws InputError  as merged()
std::vector<PetscInt> joined_to(const RawMesh& first, const RawMesh& second, const std::vector<Seam>& seams,
                                double tolerance);

}  // namespace floe::generate
