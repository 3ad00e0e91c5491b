#pragma once
#include "floe/dynamics/spatial_joint.h"

namespace floe::dynamics {

/// Two places as the rows of a constraint see them at one instant.
struct SeenPair {
  const SpatialPose& first;
  const SpatialPose& second;
  ConstraintLevel level;
  double t;
  /// D2 E(t)', its spin and its spin rate; of a constraint without angle, those of the second place.
  Eigen::Matrix3d rotated;
  Eigen::Vector3d rotated_spin, rotated_spin_rate;

  SeenPair(const SpatialPair& pair, const TimeFunction& angle, const Motion& motion);
};

/// C at the level asked for, and its derivative by the virtual motions at level position.
struct RowValue {
  double C = 0;
  Vector12 gradient = Vector12::Zero();
};

/// @throws RunError  the places of a Separation coincide
RowValue evaluate(const SpatialRow& row, const SeenPair& pair);

/// Y += d(lambda gradient) by the virtual motions.
void add_curvature(const SpatialRow& row, const SeenPair& pair, double lambda, Matrix12& Y);

}  // namespace floe::dynamics
