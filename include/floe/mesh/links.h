#pragma once
#include <vector>

#include "floe/mesh/deck.h"
#include "floe/mesh/raw_mesh.h"

namespace floe::mesh {

/// A node that moves rigidly with another one: u = u_leader + theta_leader x arm, theta = theta_leader.
struct Follower {
  PetscInt node, leader;  ///< numbers of the RawMesh
};

/// The deck's rigid links as pairs, ascending by node, the same on all ranks.
///
/// @throws InputError  one line a fault, by labels: a node that follows two others, or one that follows itself
/// Collective.
std::vector<Follower> followers(const RawMesh& mesh, const std::vector<RigidLink>& links);

/// The leader of a node, or the node itself. `followers` ascends.
PetscInt leader_of(const std::vector<Follower>& followers, PetscInt node);

}  // namespace floe::mesh
