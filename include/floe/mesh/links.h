#pragma once
#include <array>
#include <vector>

#include "floe/mesh/deck.h"
#include "floe/mesh/raw_mesh.h"

namespace floe::mesh {

/// A node that moves rigidly with another one: u = u_independent + theta_independent x arm, theta = theta_independent;
/// or, where rotations are its own, theta = theta_independent but for those: the one about its axis e, as of a node of
/// a line hinge, or with `others` those about all axes normal to e (about all, where it has none).
struct DependentNode {
  PetscInt node, independent_node;  ///< numbers of the RawMesh
  std::array<double, 3> axis = {};  ///< unit vector; zero: none
  bool others = false;
  bool spins() const { return others || axis != std::array<double, 3>{}; }
};

/// The deck's rigid links as pairs, ascending by node, the same on all ranks. Rotations that a link leaves free follow
/// it where no beam, shell or spring resists them: of a dependent node, or of an independent one without mass whose
/// dependent nodes are at one point or on one line.
///
/// @throws InputError  one line a fault, by labels: a node that follows two others, itself, or one with rotations of
/// its
///                     own
/// Collective.
std::vector<DependentNode> dependent_nodes(const RawMesh& mesh, const Deck& deck);

/// The same rigid regions, whose independent node is one that has elements where only nodes at one point have any: an
/// element at an arm of the independent node has no displacements of second order in its slopes, so that an arm across
/// a beam would resist rotations, the more the shorter the element.
///
/// @param kept  independent nodes that stay such; same on all ranks
/// Collective.
std::vector<DependentNode> with_independent_elements(const RawMesh& mesh, std::vector<DependentNode> dependent_nodes,
                                                     const std::vector<PetscInt>& kept);

/// The independent node of a node, or the node itself. `dependent_nodes` ascends.
PetscInt independent_node_of(const std::vector<DependentNode>& dependent_nodes, PetscInt node);

}  // namespace floe::mesh
