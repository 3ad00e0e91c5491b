#pragma once
#include <memory>
#include <vector>

#include "floe/dynamics/attitude.h"
#include "floe/dynamics/term.h"

namespace floe::dynamics {

/// A part of a body that a cut separates from the rest, by the terms that act on it: its inertia and all loads and
/// connections but those of the cut.
///
/// Every term's rows at the coordinates of a frame are the resultant of its forces, as the body moves rigidly with the
/// frame. So their sum is what the cut exerts on the part:
///
///   (f, m) = sum over terms of rows (R, theta) = inertia - applied forces
struct Cut {
  std::vector<std::shared_ptr<const Term>> own;   ///< of the cut alone, not of a system
  std::vector<const Term*> shared;                ///< of a system, which outlives the cut
  int frame = -1;                                 ///< local index of the frame's R; rotations follow
  std::shared_ptr<const Attitude> attitude = {};  ///< in space; null: in the plane
};

/// Force [N] and moment [N m] about the frame's origin that the cut exerts on the part, world axes; in the plane f_z,
/// m_x and m_y are zero. The share of this rank's terms: ranks add up.
/// @param q, v, a  local coordinates of the system, their rates and accelerations
Wrench on_part(const Cut& cut, double t, const Eigen::VectorXd& q, const Eigen::VectorXd& v, const Eigen::VectorXd& a);

}  // namespace floe::dynamics
