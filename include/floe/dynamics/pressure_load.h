#pragma once
#include <functional>
#include <memory>

#include "floe/body/pressure.h"
#include "floe/dynamics/attitude.h"
#include "floe/dynamics/term.h"

namespace floe::dynamics {

/// A pressure p(t) on a body's surface, or on one element of it.
///
/// Normal to the deformed surface to first order in the elastic coordinates e (body::Pressure):
///
///   r_R -= A p (force + force_by e),  r_x -= p (moment + moment_by e),  r_e -= p (load + load_by e)
///
/// or, dead, along the normals n at the start, A_0 n in world axes: with B = A'A_0 and C = spread + sum_j e_j spread_j,
///
///   r_R -= A_0 p force,  r_x -= p axial(C B'),  r_e_j -= p spread_j : B
///
/// The tangent is exact. A frame that stands still has no R and x.
class PressureLoad final : public Term {
 public:
  enum class Kind { follower, dead };
  /// @param coordinates  the frame's six, if it moves, then as many as `pressure` has
  /// @param attitude     null: the frame stands still
  /// @param start        A_0
  PressureLoad(std::vector<int> coordinates, std::shared_ptr<const Attitude> attitude, body::Pressure pressure,
               std::function<double(double)> value, Kind kind, const Eigen::Matrix3d& start);
  const std::vector<int>& coordinates() const override { return coordinates_; }
  void residual(const Motion& motion, Eigen::VectorXd& r) const override;
  void tangent(const Motion& motion, Weights weights, Eigen::MatrixXd& J) const override;

 private:
  Eigen::Index frame() const { return attitude_ ? 6 : 0; }
  Eigen::Matrix3d spread(const Motion& motion) const;
  void add_dead_tangent(const Motion& motion, double p, Eigen::MatrixXd& J) const;
  std::vector<int> coordinates_;
  std::shared_ptr<const Attitude> attitude_;
  body::Pressure unit_;
  std::function<double(double)> value_;
  Kind kind_;
  Eigen::Matrix3d start_;
};

}  // namespace floe::dynamics
