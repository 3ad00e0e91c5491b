#pragma once
#include "floe/mesh/links.h"
#include "floe/scene/scene.h"

namespace floe::plan {
using namespace scene;

/// Rigid regions whose independent nodes have elements (mesh::with_independent_elements), unless the body's frame or a
/// joint to the ground holds the given one, which then does not rotate. Collective.
std::vector<mesh::DependentNode> with_independent_nodes(const Scene& scene, const Body& body, const mesh::RawMesh& mesh,
                                                        const std::vector<mesh::DependentNode>& links,
                                                        const mesh::NodeSets& places);

/// Places of the body that its joints hold as one rigid piece each.
std::vector<std::vector<PetscInt>> rigid_pieces(const Scene& scene, const Body& body, const mesh::NodeSets& places);

/// Nodes that links of a deck leave rotations of their own are no part of an edge that a joint holds as one, rigid or
/// as a line hinge, nor do supports hold their rotations. @throws InputError  otherwise
void refuse_loose_edges(const Scene& scene, const Body& body, const std::vector<mesh::DependentNode>& links,
                        const mesh::NodeSets& places, const mesh::RawMesh& mesh);

}  // namespace floe::plan
