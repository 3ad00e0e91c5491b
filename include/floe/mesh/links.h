#pragma once
#include <array>
#include <vector>

#include "floe/mesh/deck.h"
#include "floe/mesh/raw_mesh.h"

namespace floe::mesh {

/// A node that moves rigidly with another one: u = u_independent + theta_independent x arm, theta = theta_independent;
/// or, where it has an axis e, as a node of a line hinge: theta = theta_independent but for the rotation about e, which
/// is its own.
struct DependentNode {
  PetscInt node, independent_node;  ///< numbers of the RawMesh
  std::array<double, 3> axis = {};  ///< unit vector; zero: none
  bool spins() const { return axis != std::array<double, 3>{}; }
};

/// The deck's rigid links as pairs, ascending by node, the same on all ranks.
///
/// @throws InputError  one line a fault, by labels: a node that follows two others, or one that follows itself
/// Collective.
std::vector<DependentNode> dependent_nodes(const RawMesh& mesh, const std::vector<RigidLink>& links);

/// The independent node of a node, or the node itself. `dependent_nodes` ascends.
PetscInt independent_node_of(const std::vector<DependentNode>& dependent_nodes, PetscInt node);

}  // namespace floe::mesh
