#pragma once
#include <Eigen/Geometry>

#include "floe/plan/body_mesh.h"
#include "floe/plan/prepare.h"

namespace floe::plan {

/// The floating frame's axes as columns in mesh axes, and its origin there.
Eigen::Isometry3d frame_in_mesh(const PlannedBody& body);

/// Nodes of what stands for an element in pictures: itself, or between the nodes of one of second order several.
std::vector<std::vector<int>> pictured(fem::CellKind kind);

/// A body's mesh as files hold it: this rank's nodes and cells in original numbers, positions in the frame, no columns.
output::ReducedShapes mesh_copy(const PlannedBody& body);
/// The same with its dependent nodes; null: a body from a file has its mesh there.
std::shared_ptr<const BodyMesh> body_mesh(const PlannedBody& body);

}  // namespace floe::plan
