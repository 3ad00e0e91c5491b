#pragma once
#include "floe/mesh/inp.h"
#include "floe/scene/scene.h"

namespace floe::scene {

/// Sections of a deck's parts, as floe's elements take them. Section axes: y is the deck's 1-direction, z its
/// 2-direction.
///
/// Shells: OFFSET moves the middle the other way; plies from below; all plies of a section are turned against one axis.
/// @throws InputError  one line a fault: material missing or without elasticity, unsymmetric box and I profiles, plies
///                     of different orientations
std::vector<PartSpec> deck_sections(const mesh::InpFile& file);

/// Adds the deck's point masses to the mesh as cells of one node, in parts `mass M` for each value. Collective.
void add_masses(mesh::InpFile& file, std::vector<PartSpec>& parts);

}  // namespace floe::scene
