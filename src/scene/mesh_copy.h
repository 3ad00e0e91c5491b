#pragma once
#include "build_prepare.h"

namespace floe::scene {

/// A body's mesh as files hold it: this rank's nodes and cells in original numbers, positions in the frame, no columns.
output::ReducedShapes mesh_copy(const PreparedBody& body);

}  // namespace floe::scene
