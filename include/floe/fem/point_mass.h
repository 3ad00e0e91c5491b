#pragma once
#include "floe/fem/element.h"

namespace floe::fem {

/// A rigid mass carried by a spatial node (u, v, w, rx, ry, rz): an element of one node without stiffness.
///
/// Six mass points at +-sqrt(3 s/m) along the principal axes of int rho r r' = 1/2 tr(J) I - J (s its eigenvalues;
/// fewer where they vanish), so that mass, centre and inertia are exact. N = [I, -[r]x]; the mass rotates to
/// second order (body::RotatingMass), about its centre and on the arm `offset`.
/// @param node    position of the node in body axes
/// @param mass    > 0 [kg]
/// @param inertia J about the mass centre, body axes [kg m2]: symmetric, and its principal moments obey
///                J1 + J2 >= J3 (no real mass has other)
/// @param offset  of the mass centre from the node [m]
/// @throws floe::InputError  what the conditions above exclude
ElementMaps point_mass(const Eigen::Vector3d& node, double mass, const Eigen::Matrix3d& inertia,
                       const Eigen::Vector3d& offset = Eigen::Vector3d::Zero());

}  // namespace floe::fem
