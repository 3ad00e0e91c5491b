#pragma once
#include "floe/mesh/inspect.h"

namespace floe::mesh {

/// Counts the components into `result`. Each rank joins its own cells first; then the least node of each piece travels
/// between the ranks until nothing changes. Collective.
void find_components(const RawMesh& mesh, const std::vector<std::array<PetscInt, 2>>& connections, Inspection& result);

}  // namespace floe::mesh
