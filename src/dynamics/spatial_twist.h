#pragma once
#include "floe/dynamics/revolutions.h"
#include "floe/dynamics/spatial_pair.h"

namespace floe::dynamics {

/// Twist of the second place against the first about z (SpatialSpring), and its rate h.(w_2 - w_1).
struct Twist {
  double angle, rate;
  Eigen::Vector3d h, slip;                     ///< slip = w_2 - w_1
  std::array<Eigen::Matrix3d, 2> by_rotation;  ///< dh = by_rotation[0] dphi_1 + by_rotation[1] dphi_2
};

/// @param nearest  the angle is the one within half a turn of this
/// @throws RunError  z_2 = -z_1: there is no twist
Twist twist(const SpatialPair& pair, double nearest);

/// A step begins at a motion that the pair was evaluated at (Term::begin_step).
void begin(Revolutions& revolutions, const SpatialPair& pair, double t);

}  // namespace floe::dynamics
