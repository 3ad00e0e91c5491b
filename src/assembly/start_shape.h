#pragma once
#include "floe/assembly/reduce_bodies.h"

namespace floe::assembly {

/// Coordinates of a reduced body whose shape at the start is given: of those that move the places of its joints as the
/// shape does, as far as its columns can, the ones nearest to the shape.
///
///   min |eta - V'M u|   with   S eta = u at the places of joints
///
/// The shape's projection alone would open joints by what the columns leave out.
/// @param shape  u, in the frame
/// Collective.
Eigen::VectorXd start_shape(const Plan& plan, int body, const ReducedBody& reduced, Vec shape);

/// What is expected of the places of a joint that are apart at the start: the same point, or columns that can take the
/// shape which the scene gives to one of its bodies.
std::string expected_to_meet(const Plan& plan, Formulation formulation, std::size_t joint);

}  // namespace floe::assembly
