#pragma once
#include "floe/fem/structure.h"

namespace floe::fem {

/// Where a second structure of the same elements lies against the first, both undeformed: x -> R x + r.
struct Placement {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  ///< R
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();   ///< r
  bool rotates = false;                                    ///< R is not 1
};

/// Whether b is a at a placement: the same cells of the same nodes on the same ranks, positions to 1e-12 of the
/// largest, and equal sections. False where line hinges rotate, whose own rotation is a component in the axes.
/// Rank-local.
bool congruent(const Structure& a, const Structure& b, const Placement& placement);

/// A field of a on b: displacements and rotation vectors of nodes are rotated, v -> R v. Collective.
petsc::VecHandle placed(const Structure& b, const Placement& placement, Vec field);

}  // namespace floe::fem
