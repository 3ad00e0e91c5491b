#pragma once
#include "floe/body/elasticity.h"
#include "floe/body/floating_frame.h"
#include "floe/body/inertia.h"
#include "floe/dynamics/term.h"

namespace floe::dynamics {

/// A body, or one element of it, in a floating frame: inertia with all its couplings, elastic force, viscous damping.
///
/// Coordinates (R_x, R_y, theta, q_1 ... q_k). A full-order body is the sum of its elements, each one such term with
/// the element's dofs as q and the frame shared; a reduced body is a single term with k generalised coordinates.
class FloatingBody final : public Term {
 public:
  /// @param damping  k x k, or empty for none: r_q += D q.
  FloatingBody(std::vector<int> coordinates, body::PlanarInertia inertia, body::Elasticity elasticity,
               Eigen::MatrixXd damping = {});

  const std::vector<int>& coordinates() const override { return coordinates_; }
  void residual(const Motion& motion, Eigen::VectorXd& r) const override;
  void tangent(const Motion& motion, Weights weights, Eigen::MatrixXd& J) const override;
  Energy energy(const Motion& motion) const override;

 private:
  std::vector<int> coordinates_;
  body::PlanarInertia inertia_;
  body::Elasticity elasticity_;
  Eigen::MatrixXd damping_;
  mutable body::InertiaWork inertia_work_;
  mutable body::ElasticityWork elasticity_work_;
  mutable Eigen::VectorXd elastic_;
};

}  // namespace floe::dynamics
