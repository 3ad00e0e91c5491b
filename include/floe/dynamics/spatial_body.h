#pragma once
#include <memory>

#include "floe/body/elasticity.h"
#include "floe/body/spatial_frame.h"
#include "floe/dynamics/attitude.h"
#include "floe/dynamics/term.h"

namespace floe::dynamics {

/// A body in a frame that floats in space: inertia with all its couplings, elastic force, viscous damping.
///
/// Coordinates (R [3], x [3], e_1 ... e_k), A = base exp(x); rates (R', omega, e') with omega in body axes; the rows of
/// x are moments about body axes (Attitude). Tangents are exact for any x.
class SpatialBody final : public Term {
 public:
  /// @param attitude  of the frame, shared with the System and with all that acts on the body
  /// @param damping   k x k, or empty for none: r_e += D e'.
  SpatialBody(std::vector<int> coordinates, std::shared_ptr<const Attitude> attitude, body::SpatialInertia inertia,
              body::Elasticity elasticity, Eigen::MatrixXd damping = {});

  const std::vector<int>& coordinates() const override { return coordinates_; }
  void residual(const Motion& motion, Eigen::VectorXd& r) const override;
  void tangent(const Motion& motion, Weights weights, Eigen::MatrixXd& J) const override;
  Energy energy(const Motion& motion) const override;
  /// About the origin of the world, world axes.
  body::Momentum momentum(const Motion& motion) const;

 private:
  Eigen::Matrix3d axes(const Motion& motion) const { return attitude_->axes(motion.q.segment<3>(3)); }

  std::vector<int> coordinates_;
  std::shared_ptr<const Attitude> attitude_;
  body::SpatialInertia inertia_;
  body::Elasticity elasticity_;
  Eigen::MatrixXd damping_;
  mutable body::SpatialInertiaWork inertia_work_;
  mutable body::ElasticityWork elasticity_work_;
  mutable Eigen::VectorXd elastic_;
};

}  // namespace floe::dynamics
