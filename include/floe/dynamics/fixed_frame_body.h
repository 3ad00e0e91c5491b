#pragma once
#include <functional>

#include "floe/body/elasticity.h"
#include "floe/dynamics/term.h"

namespace floe::dynamics {

/// A body, or one element of it, in a frame that stands still: M q.. + D q. + dU/dq = 0.
///
/// What the floating frame's couplings leave of FloatingBody when the frame is fixed to the ground; for any number of
/// dimensions.
class FixedFrameBody final : public Term {
 public:
  /// @param mass     k x k, symmetric [kg]
  /// @param damping  k x k, or empty for none
  FixedFrameBody(std::vector<int> coordinates, Eigen::MatrixXd mass, body::Elasticity elasticity,
                 Eigen::MatrixXd damping = {});
  const std::vector<int>& coordinates() const override { return coordinates_; }
  void residual(const Motion& motion, Eigen::VectorXd& r) const override;
  void tangent(const Motion& motion, Weights weights, Eigen::MatrixXd& J) const override;
  Energy energy(const Motion& motion) const override;

 private:
  std::vector<int> coordinates_;
  Eigen::MatrixXd mass_, damping_;
  body::Elasticity elasticity_;
  mutable body::ElasticityWork work_;
};

/// A force that keeps its direction, on a place that moves with coordinates of a still frame by S q + 1/2 Q(q, q):
/// r -= (S + Q q)' f(t).
///
/// With S = int rho N and f = g it is gravity, with S = int N over a line or surface a uniform load.
class DeadForce final : public Term {
 public:
  /// @param S      d x k, displacement (or its integral) of the place
  /// @param force  f(t), d, in the frame's axes
  /// @param Q      of each component, symmetric; empty: zero
  DeadForce(std::vector<int> coordinates, Eigen::MatrixXd S, std::function<Eigen::VectorXd(double)> force,
            std::vector<Eigen::MatrixXd> Q = {});
  const std::vector<int>& coordinates() const override { return coordinates_; }
  void residual(const Motion& motion, Eigen::VectorXd& r) const override;
  void tangent(const Motion& motion, Weights weights, Eigen::MatrixXd& J) const override;
  Energy energy(const Motion& motion) const override;
  /// Counts -f.(S q + 1/2 Q(q, q)) as potential energy: for forces that are constant in time (gravity).
  bool conservative = false;

 private:
  std::vector<int> coordinates_;
  Eigen::MatrixXd S_;
  std::function<Eigen::VectorXd(double)> force_;
  std::vector<Eigen::MatrixXd> Q_;
};

}  // namespace floe::dynamics
