#pragma once
#include "floe/scene/scene.h"

namespace floe::assess {
using namespace scene;

/// Whether every flexible body with a mesh has as many modes as its reduction asks for, under their conditions. Bodies
/// of at least twelve dofs for each mode are taken to have them; of others the stiffness is factored.
/// @return  the number of attachment modes of each body (pieces of bodies in several frames count as bodies), before
/// those are dropped that others span
/// @throws InputError  a line for each that has not; RunError. Collective.
std::vector<int> check_modes(const Scene& scene, MPI_Comm comm);

}  // namespace floe::assess
