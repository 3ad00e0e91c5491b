#pragma once
#include <array>
#include <vector>

#include "floe/mesh/deck.h"
#include "floe/mesh/raw_mesh.h"

namespace floe::mesh {

/// A node that moves rigidly with another one: u = u_leader + theta_leader x arm, theta = theta_leader; or, where it
/// has an axis e, as a node of a line hinge: theta = theta_leader but for the turn about e, which is its own.
struct Follower {
  PetscInt node, leader;            ///< numbers of the RawMesh
  std::array<double, 3> axis = {};  ///< unit vector; zero: none
  bool spins() const { return axis != std::array<double, 3>{}; }
};

/// The deck's rigid links as pairs, ascending by node, the same on all ranks.
///
/// @throws InputError  one line a fault, by labels: a node that follows two others, or one that follows itself
/// Collective.
std::vector<Follower> followers(const RawMesh& mesh, const std::vector<RigidLink>& links);

/// The leader of a node, or the node itself. `followers` ascends.
PetscInt leader_of(const std::vector<Follower>& followers, PetscInt node);

}  // namespace floe::mesh
