#pragma once
#include <optional>

#include "floe/plan/prepare_spatial.h"

namespace floe::plan {

/// The line of a place's nodes, a unit vector from the first one towards their mean; nothing where they lie on none.
/// Collective.
std::optional<Eigen::Vector3d> line_of(const fem::Mesh& mesh, const Anchor& place);

/// A frame's axes rotated so that as many directions as can be are along one of them each, those that come first before
/// others, and each by the smallest rotation.
/// @param kept  the column that has to stay; -1: none
Eigen::Matrix3d axes_along(Eigen::Matrix3d axes, int kept, const std::vector<Eigen::Vector3d>& directions);

/// The line of a straight mesh, or the normal of a flat one; nothing for others.
///
/// In a frame with this axis what stretches the body and what bends it are forces and moments of their own. In another
/// one every force of a joint does both, the static responses to three of them differ by the share of stretching alone,
/// (thickness / length)^2, and so do their derivatives, which are then made of round-off. Collective.
std::optional<Eigen::Vector3d> axis_of_shape(const fem::Mesh& mesh);

/// Axes of the joints by which the ground holds the body in some directions only, in mesh axes: of edges, then of
/// nodes.
///
/// Conditions hold single dofs. In a frame with these axes they hold what such a joint does, however the mesh lies.
/// Collective.
std::vector<Eigen::Vector3d> ground_axes(const Scene& scene, const Body& body, const SpatialMesh& mesh);

}  // namespace floe::plan
