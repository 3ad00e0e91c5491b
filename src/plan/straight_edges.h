#pragma once
#include <map>

#include "floe/mesh/raw_mesh.h"
#include "floe/scene/scene.h"

namespace floe::plan {
using namespace scene;

/// Adds to the mesh the springs that keep edges of the body straight (Joint::straight of its supports): between
/// neighbours on the edge a stiff spring in the direction e of the displacements that vary linearly along it, and about
/// t x e, t along the edge,
///
///   k = c A L/l,   k_theta = c A L^3/l,   A membrane stiffness [N/m], l, L lengths of a segment and of the edge:
///
/// the edge is a beam of bending stiffness c A L^3 in the plane of t and e, without any other stiffness. c = 1000: what
/// bends it in the plane of a shell is resisted by the shell's own A.
///
/// @param places  nodes by name, the same on all ranks
/// @param parts   sections of the mesh's parts that the scene does not give; those of the springs are added
/// @param stiffness  A, the maximum of all shells
/// @throws InputError  a place of less than three nodes, with coincident ones, that is not straight, or along e; e
/// normal to the shells. Collective.
void add_straight_edges(const Scene& scene, const Body& body, const mesh::NodeSets& places, double stiffness,
                        mesh::RawMesh& raw, std::map<int, fem::Section>& parts);

/// Whether supports have straight edges of this body.
bool has_straight_edges(const Scene& scene, const Body& body);

}  // namespace floe::plan
