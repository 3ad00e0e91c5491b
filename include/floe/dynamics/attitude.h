#pragma once
#include "floe/math/rotation.h"

namespace floe::dynamics {

/// The attitude of a frame in space: A = base exp(x), where x are three unknowns of the system.
///
/// What stands for x among the velocities is the angular velocity in the frame's axes, among the accelerations its
/// rate, and in the residual the moment about the frame's axes. At the beginning of each step base takes over exp(x)
/// and x becomes zero: there are no singular attitudes, x stays below one step's rotation, and plain sums of a
/// generalised-alpha step are the sums of the Lie algebra (Bruels, Cardona, Arnold 2012, Lie group generalized-alpha
/// time integration of constrained flexible multibody systems). Terms and markers of one frame share it.
struct Attitude {
  Eigen::Quaterniond base = Eigen::Quaterniond::Identity();
  /// Whether elements take their strains from it, relative to their own frames: whole revolutions within one step are
  /// strains that they do not see.
  bool of_node = false;

  /// A at x.
  Eigen::Matrix3d axes(const Eigen::Vector3d& x) const { return (base * math::quaternion(x)).toRotationMatrix(); }
  /// base <- base exp(x), of unit length.
  void advance(const Eigen::Vector3d& x) { base = (base * math::quaternion(x)).normalized(); }
};

}  // namespace floe::dynamics
