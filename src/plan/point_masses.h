#pragma once
#include <map>

#include "floe/fem/structure.h"
#include "floe/mesh/raw_mesh.h"
#include "floe/scene/scene.h"

namespace floe::plan {

/// Adds the body's own masses (scene::MassSpec) to a mesh as cells of one node, each a part of its own.
///
/// @param places  nodes by name, the same on all ranks
/// @param parts   receives their sections by the number of the part
/// @throws InputError  a place that is not there or has several nodes; no node at a point; an inertia that no mass has.
/// Collective.
void add_masses(const scene::Body& body, const mesh::NodeSets& places, mesh::RawMesh& raw,
                std::map<int, fem::Section>& parts);

}  // namespace floe::plan
