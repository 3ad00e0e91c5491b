#pragma once
#include "floe/dynamics/connection.h"
#include "floe/dynamics/marker.h"

namespace floe::dynamics {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// What of `wrench`, of both places as rows of the equations of motion have it, acts on the second place.
Wrench on_second_place(const Vector6& wrench);

/// Two markers, of two bodies or of one, seen through their poses y = (x_1, y_1, angle_1, x_2, y_2, angle_2).
///
/// What acts between two places is written in y alone; this maps it to the bodies' coordinates.
struct MarkerPair {
  Marker first, second;
  std::vector<int> coordinates;  ///< of both, each once; a term may add its own behind
  std::vector<int> where_first, where_second;
  Pose pose_first, pose_second;
  /// The coordinates of one marker, and their rates.
  struct State {
    Eigen::VectorXd q, v, a;
  };
  State state_first, state_second;  ///< of their coordinates

  MarkerPair(Marker first, Marker second);
  /// Evaluates both poses.
  void evaluate(const Motion& motion, EvaluationLevel level = EvaluationLevel::velocity);
  Vector6 y() const;
  Vector6 yd() const;
  Vector6 ydd() const;
  /// r += (dy/dq)' wrench
  void add(const Vector6& wrench, Eigen::VectorXd& r) const;
  /// r += (d(yd)/dq at fixed v)' by_rates
  void add_rate_gradient(const Vector6& by_rates, Eigen::VectorXd& r) const;
  /// J += derivative of add(wrench(y, yd), r): Y = dwrench/dy, Yd = dwrench/dyd.
  void add_tangent(const Vector6& wrench, const Matrix6& Y, const Matrix6& Yd, Weights weights,
                   Eigen::MatrixXd& J) const;
};

}  // namespace floe::dynamics
