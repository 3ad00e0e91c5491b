#pragma once
#include "build_prepare.h"
#include "floe/scene/body_mesh.h"

namespace floe::scene {

/// A body's mesh as files hold it: this rank's nodes and cells in original numbers, positions in the frame, no columns.
output::ReducedShapes mesh_copy(const PreparedBody& body);
/// The same with its followers; null: a body from a file has its mesh there.
std::shared_ptr<const BodyMesh> body_mesh(const PreparedBody& body);

}  // namespace floe::scene
