#pragma once
#include <map>

#include "floe/mesh/pieces.h"
#include "floe/scene/scene.h"

namespace floe::plan {
using namespace scene;

/// Edges of the body that its joints hold as hinge lines (Joint::Edges::line): straight, along the joint's axis.
///
/// A hinge pin is rigid against bending and stretching and hinders no rotation about itself: the edge's nodes keep
/// their places on it, their rotations normal to it are the pin's, those about it their own (fem::Mesh). In Kirchhoff's
/// theory this is a simply supported edge whose support moves: no moment about the edge at any point of it, and so no
/// mean one.
///
/// An edge that has no such line, and is not specified as one, is left to its mean. Edges that the ground holds are
/// lines where they have no conflict with others (mesh::with_lines); else every node of theirs is constrained by
/// itself.
///
/// @param places   nodes by name, the same on all ranks
/// @param notices  receives straight edges whose joint has another axis
/// @throws InputError  specified as a line, and is none. Collective.
std::vector<mesh::HingeLine> hinge_lines(const Scene& scene, const Body& body, const mesh::RawMesh& mesh,
                                         const mesh::NodeSets& places, std::vector<std::string>& notices);

/// Says of edges that the ground holds and that could not be lines (mesh::with_lines) what holds them now.
///
/// @param left_out  where their joints stand
/// @throws InputError  specified as a line
void report_left_out(const Scene& scene, const std::vector<std::string>& left_out, std::vector<std::string>& notices);

/// Nodes of the body's edges that the ground clamps, and those that its frame goes through.
std::vector<PetscInt> constrained_elsewhere(const Scene& scene, const Body& body, const mesh::NodeSets& places);

}  // namespace floe::plan
