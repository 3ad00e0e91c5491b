#pragma once
#include <array>

#include "floe/dynamics/connection.h"
#include "floe/dynamics/spatial_marker.h"

namespace floe::dynamics {

using Vector12 = Eigen::Matrix<double, 12, 1>;
using Matrix12 = Eigen::Matrix<double, 12, 12>;

/// Two places in space, of two bodies or of one or of the ground.
///
/// What acts between them is written in world axes: wrenches (f_1, m_1, f_2, m_2) that work on the virtual motions
/// (dp_1, dphi_1, dp_2, dphi_2), and their derivatives; this maps them to the bodies' coordinates.
struct SpatialPair {
  std::array<SpatialMarker, 2> marker;
  std::vector<int> coordinates;  ///< of both, each once; a term may add its own behind
  std::array<std::vector<int>, 2> where;
  std::array<SpatialPose, 2> pose;

  SpatialPair(SpatialMarker first, SpatialMarker second);
  /// Evaluates both poses: add() needs their places, add_gradient() too, add_tangent() directions, with Yd the motion.
  void evaluate(const Motion& motion, EvaluationLevel level = EvaluationLevel::velocity);
  /// r += P' wrench: the rows of a wrench.
  void add(const Vector12& wrench, Eigen::VectorXd& r);
  /// r += the derivative by the coordinates of a number whose derivative by the virtual motions is `gradient`: as the
  /// rows of a wrench, with T(x)' on those of x.
  void add_gradient(const Vector12& gradient, Eigen::VectorXd& r);
  /// r += the derivative by the coordinates, at fixed velocities, of a number whose derivative by (velocity_1, spin_1,
  /// velocity_2, spin_2) is `by_rates`. Needs the motion.
  void add_rate_gradient(const Vector12& by_rates, Eigen::VectorXd& r);
  /// J += derivative of add(wrench, r).
  ///
  /// @param Y   change of the wrench with the virtual motions at fixed velocities and spins
  /// @param Yd  dwrench/d(velocity_1, spin_1, velocity_2, spin_2)
  void add_tangent(const Vector12& wrench, const Matrix12& Y, const Matrix12& Yd, Weights weights, Eigen::MatrixXd& J);

 private:
  /// Change of both wrenches with the coordinates of place j, into change_[j].
  void differentiate(const Matrix12& Y, const Matrix12& Yd, bool damped, Weights weights, int j);
  struct State {
    Eigen::VectorXd q, v, a;
  };
  // work arrays, one for each place or pair of places so that they keep their sizes
  std::array<State, 2> state_;
  Eigen::VectorXd rows_;
  std::array<Matrix6Xd, 2> rates_;
  std::array<Eigen::Matrix<double, 12, Eigen::Dynamic>, 2> change_;
  std::array<std::array<Eigen::MatrixXd, 2>, 2> block_;
};

}  // namespace floe::dynamics
