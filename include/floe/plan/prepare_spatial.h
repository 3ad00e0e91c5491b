#pragma once
#include "floe/plan/prepare.h"

namespace floe::plan {

/// A body in space on its mesh: read or generated, inspected, spread over the ranks, with its sections.
struct SpatialMesh {
  fem::Structure structure;        ///< in mesh axes
  mesh::NodeSets places;           ///< global nodes by name, the same on all ranks
  std::vector<std::string> parts;  ///< names
  std::vector<std::string> notices;
  std::string strains;                         ///< which, and of a default the number that decides (fem::StrainsChoice)
  std::vector<fem::StressPoints> points = {};  ///< of each part
};
/// @param scene  its joints make rigid regions of the places that they hold (holds_a_piece)
/// @throws InputError  the same on all ranks. Collective.
SpatialMesh spatial_mesh(const Scene& scene, const Body& body, MPI_Comm comm);

/// Whether the joint makes one rigid region of a place of many nodes (`edges`), and does not clamp it to the ground,
/// where every node is constrained.
bool holds_a_piece(const Joint& joint);

/// Where a structure's axes lie in those of its mesh: x_mesh = origin + axes x.
struct MeshAxes {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
};

/// Of places that are sets of nodes, which reading a scene does not know.
/// @throws InputError  a joint between a place and itself, or two joints for one pair of places
void check_pairs(const Plan& plan);

/// Nodes of a place of the body, with their mean position in the structure's axes.
/// @param place  a point is in mesh axes
/// @throws InputError  no such set, no node there. Collective.
Anchor spatial_place(const Body& body, const fem::Structure& structure, const mesh::NodeSets& places,
                     const Place& place, const MeshAxes& mesh = {});

/// The parts of a load per length or area: where its shape is positive, and where it is negative.
/// @param place  of it, found
/// @throws InputError  the place has no edges, or no shells, or its shape is zero there. Collective.
std::vector<LoadPart> spread_load(const Load& load, const fem::Structure& structure, const Anchor& place,
                                  const MeshAxes& mesh);

/// Bodies, frames and constrained dofs of a scene in space. Collective.
Plan prepare_spatial(const Scene& scene, MPI_Comm comm);

}  // namespace floe::plan
