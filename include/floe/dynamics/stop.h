#pragma once
#include <cmath>

#include "floe/dynamics/joint_force.h"

namespace floe::dynamics {

/// Springs and dampers beyond two values of a coordinate x. With the depth d = lower - x or x - upper:
///
///   d <= 0      nothing
///   d <= width  stiffness d^2 / (2 width) + damping s^2 (3 - 2 s) d.,   s = d / width
///   else        stiffness (d - width / 2) + damping d.
///
/// The force and its derivatives by d and d. are continuous, so that Newton's method and step control go through it.
struct StopLaw {
  double lower = -INFINITY, upper = INFINITY;
  double stiffness = 0, damping = 0;
  double width = 1e-3;  ///< > 0

  ForceOnCoordinate at(double x, double rate) const;
};

/// Stops of a joint's free coordinate, since the start.
class Stop final : public JointForce {
 public:
  Stop(std::unique_ptr<RelativeCoordinate> of, StopLaw law, std::shared_ptr<const ConstraintSwitch> active = {})
      : JointForce(
            std::move(of), [law](double x, double rate) { return law.at(x, rate); }, std::move(active)),
        law_(law) {}
  const StopLaw& law() const { return law_; }

 private:
  StopLaw law_;
};

}  // namespace floe::dynamics
