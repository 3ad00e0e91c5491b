#pragma once
#include "floe/assembly/body_stage.h"
#include "floe/fem/congruence.h"

namespace floe::assembly {

/// The body before a body whose reduction it has.
struct SharedReduction {
  int of = -1;  ///< index of the first body of the same reduction; -1: none
  fem::Placement placement;
};

/// Of each body whether one before it has the same reduction, by comparison of all that a reduction is made from:
/// elements and sections (fem::congruent), conditions of frame, joints and interface, attachment modes and the settings
/// of the scene. Bodies may be rotated against each other in their frames where conditions hold whole displacements and
/// whole rotations of nodes, and attachment modes come in threes. Derivatives chosen by count depend on the motion, and
/// named basis vectors on the joints' names: these are not shared. Collective.
std::vector<SharedReduction> shared_reductions(const Plan& plan);

/// The reduction of `original` for another body: the rotated basis, inertia constants in its axes, the same elastic
/// energy. Collective.
ReducedBody shared_body(const Plan& plan, int body, const SharedReduction& shared, const ReducedBody& original);

}  // namespace floe::assembly
