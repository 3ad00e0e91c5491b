#pragma once
#include <functional>

#include "floe/dynamics/moving_axes.h"
#include "floe/dynamics/spatial_marker.h"
#include "floe/dynamics/term.h"

namespace floe::dynamics {

/// A force and a moment of time on a place in space: r -= P' w.
///
/// The moment works on the spin of the place: on elastic coordinates it acts by psi' T(beta).
class SpatialForce final : public Term {
 public:
  /// World axes; rotating with the body's frame A; following the rotation of the place, D; or that of other axes.
  enum class Axes { world, body, place, other };
  /// @param wrench  (f, m)(t) in those axes [N, N m]
  SpatialForce(SpatialMarker at, std::function<Wrench(double)> wrench, Axes axes);
  /// In other axes, whose coordinates follow those of the place.
  SpatialForce(SpatialMarker at, std::function<Wrench(double)> wrench, const MovingAxes& other);
  const std::vector<int>& coordinates() const override { return coordinates_; }
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
  MovingAxes other_;
  std::vector<int> coordinates_;
  mutable SpatialPose pose_;
  mutable Matrix6Xd change_;
  mutable Eigen::VectorXd rows_;
};

}  // namespace floe::dynamics
