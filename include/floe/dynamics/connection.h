#pragma once
#include "floe/dynamics/term.h"

namespace floe::dynamics {

/// A term between two places, of bodies or of the ground: a joint, a spring or a stop.
class Connection : public Term {
 public:
  /// Force [N] and moment [N m] that it exerts on its second place, about that place, in world axes; in the plane f_z,
  /// m_x and m_y are zero. On the first place the opposite force acts, on the same line. Zero while a constraint switch
  /// is open. Of the motion t, q (with multipliers) and v count.
  virtual Wrench on_second(const Motion& motion) const = 0;
};

}  // namespace floe::dynamics
