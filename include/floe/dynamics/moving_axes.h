#pragma once
#include <memory>
#include <vector>

#include "floe/dynamics/attitude.h"

namespace floe::dynamics {

/// Axes that rotate rigidly, among a system's local coordinates: of a floating frame, or of a node without one.
///
/// In space R (3) and x (3) with A = attitude(x); in the plane R (2) and an angle: A = R_z(angle + coordinate). R =
/// origin + coordinates.
struct MovingAxes {
  int position = 0, rotation = 0;                    ///< local index of the first of R, of the rotation
  std::shared_ptr<const Attitude> attitude = {};     ///< null: in the plane
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< of displacements; zero where R itself is a coordinate
  double angle = 0;                                  ///< in the plane [rad]

  bool spatial() const { return attitude != nullptr; }
  std::vector<int> coordinates() const;
};

}  // namespace floe::dynamics
