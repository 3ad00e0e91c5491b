#pragma once
#include <functional>

#include "floe/dynamics/spatial_marker.h"
#include "floe/dynamics/term.h"

namespace floe::dynamics {

/// A force and a moment of time on a place in space: r -= P' w.
///
/// The moment works on the spin of the place: on elastic coordinates it acts by psi' T(beta).
class SpatialForce final : public Term {
 public:
  /// World axes; rotating with the body's frame A; or following the rotation of the place, D.
  enum class Axes { world, body, place };
  /// @param wrench  (f, m)(t) in those axes [N, N m]
  SpatialForce(SpatialMarker at, std::function<Wrench(double)> wrench, Axes axes);
  const std::vector<int>& coordinates() const override { return at_.coordinates; }
  void residual(const Motion& motion, Eigen::VectorXd& r) const override;
  void tangent(const Motion& motion, Weights weights, Eigen::MatrixXd& J) const override;
  Energy energy(const Motion& motion) const override;
  /// Counts -f.p as potential energy: for forces constant in time and world axes, without moment (gravity).
  bool conservative = false;

 private:
  Wrench world(const Motion& motion) const;
  SpatialMarker at_;
  std::function<Wrench(double)> wrench_;
  Axes axes_;
  mutable SpatialPose pose_;
  mutable Matrix6Xd change_;
  mutable Eigen::VectorXd rows_;
};

}  // namespace floe::dynamics
