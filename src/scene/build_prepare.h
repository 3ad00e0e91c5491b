#pragma once
#include "floe/scene/model.h"

namespace floe::scene {

/// Joints, loads and probes with their places found on the meshes.
struct Prepared {
  const Scene& scene;
  MPI_Comm comm;
  std::vector<PreparedBody> bodies;
  std::vector<std::array<PreparedPlace, 2>> joints;
  std::vector<PreparedPlace> loads;                  ///< distributed ones: body only
  std::vector<std::array<PreparedPlace, 2>> probes;  ///< second: relative_to, or the ground
  double extent = 0;                                 ///< a length of the scene
  /// In space, of each joint: axes at the start in the world, z its axis, x the second axis of a universal one.
  std::vector<Eigen::Matrix3d> joint_axes = {};
  /// In space: whether the dofs that the modes hold do all that the joint does (to the ground only).
  std::vector<char> joint_held = {};
};

/// The place that the joint holds in the frame of its body: by the ground, or by a rigid body whose frame it has; null
/// when the joint is between two frames.
const PreparedPlace* held_place(const Prepared& prepared, std::size_t joint);

/// `pinned`, `clamped`, `mean-axis`.
std::string name_of(fem::ReferenceFrame::Kind kind);

/// Meshes, frames and places of a scene. Collective.
Prepared prepare(const Scene& scene, MPI_Comm comm);

Eigen::Matrix2d turn(double angle);

/// Where the system of a formulation lives: on every rank by itself, or on all together.
MPI_Comm comm_of(const Prepared& prepared, Formulation formulation);
/// Whether this rank holds what the ranks of a system share.
bool last_rank(MPI_Comm comm);

/// How a place of a reduced body moves with the body's coordinates. Collective; replicated.
struct ReducedBody;
body::PlaceMap place_map(const Prepared& prepared, const ReducedBody& reduced, const PreparedPlace& place);

}  // namespace floe::scene
