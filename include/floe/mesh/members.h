#pragma once
#include "floe/mesh/raw_mesh.h"

namespace floe::mesh {

/// Of this rank's share: the nodes that any rank told, ascending, each once. Collective.
std::vector<PetscInt> told_members(const RawMesh& mesh, const std::vector<PetscInt>& told);

/// Of this rank's share: the nodes of a place or, where no place has the name, of the cells of a part. Collective.
/// @throws InputError  neither has the name
std::vector<PetscInt> members_of(const RawMesh& mesh, const std::string& name);

}  // namespace floe::mesh
