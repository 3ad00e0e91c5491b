#pragma once
#include "floe/scene/scene.h"

namespace floe::assess {
using namespace scene;

/// Of a body: those that its joints and loads ask for, of large bodies before those are dropped that others span.
struct AttachmentModes {
  int count = 0;
  bool exact = false;
};

/// Whether every flexible body with a mesh has as many modes as its reduction asks for, under their conditions. Bodies
/// of at least twelve dofs for each mode are taken to have them; of others the stiffness is factored.
/// @return  the attachment modes of each body (pieces of bodies in several frames count as bodies)
/// @throws InputError  a line for each that has not; RunError. Collective.
std::vector<AttachmentModes> check_modes(const Scene& scene, MPI_Comm comm);

}  // namespace floe::assess
