#pragma once
#include <Eigen/Dense>
#include <span>
#include <vector>

#include "floe/dynamics/marker_pair.h"
#include "floe/dynamics/revolutions.h"
#include "floe/dynamics/spatial_pair.h"

namespace floe::dynamics {

/// A number x that says how a second place stands to a first one, in the plane or in space:
///
///   slide   x = e.(p_2 - p_1) - start, with e carried by the first place   [m]
///   rotation x = angle of the second against the first - start             [rad]
///   length  x = |p_2 - p_1| - start                                       [m]
///
/// Stops, friction and loads of joints act on it, sensors measure it. A force f on x is f dx/dq on the coordinates.
class RelativeCoordinate {
 public:
  enum class Of { slide, rotation, length };
  struct Value {
    double x, rate;
  };
  virtual ~RelativeCoordinate() = default;
  /// Of both places, each once.
  virtual const std::vector<int>& coordinates() const = 0;
  /// Evaluates both places: the functions below refer to this motion.
  /// @throws RunError  a length of 0, which has no direction; opposite z axes of a turn in space
  virtual Value see(const Motion& motion) = 0;
  /// r += force dx/dq
  virtual void add(double force, Eigen::VectorXd& r) = 0;
  /// J += derivative of add(force(x, rate), r)
  virtual void add_tangent(double force, double by_x, double by_rate, Weights weights, Eigen::MatrixXd& J) = 0;
  /// Adds the derivatives of x, or of its rate, by the coordinates at fixed velocities and by the velocities.
  virtual void add_gradient(bool of_rate, Eigen::VectorXd& by_q, Eigen::VectorXd& by_v) = 0;
  /// What f on x exerts on the second place.
  virtual Wrench on_second(double force) const = 0;
  /// Counts revolutions in space (Revolutions).
  virtual void begin_step(const Motion&) {}
  virtual void save(std::vector<double>&) const {}
  virtual std::span<const double> load(std::span<const double> carried) { return carried; }
};

/// In the plane.
class PlanarCoordinate final : public RelativeCoordinate {
 public:
  /// @param along  of a slide: e at angle_1 = 0
  PlanarCoordinate(Marker first, Marker second, Of of, double start, Eigen::Vector2d along = Eigen::Vector2d::Zero());
  const std::vector<int>& coordinates() const override { return pair_.coordinates; }
  Value see(const Motion& motion) override;
  void add(double force, Eigen::VectorXd& r) override;
  void add_tangent(double force, double by_x, double by_rate, Weights weights, Eigen::MatrixXd& J) override;
  void add_gradient(bool of_rate, Eigen::VectorXd& by_q, Eigen::VectorXd& by_v) override;
  Wrench on_second(double force) const override;

 private:
  MarkerPair pair_;
  Of of_;
  double start_;
  Eigen::Vector2d along_;
  Vector6 gradient_ = Vector6::Zero(), yd_ = Vector6::Zero();
  Matrix6 hessian_ = Matrix6::Zero();
};

/// In space: e is the third axis of the first place; the rotation is the twist of D1'D2 about z (as of SpatialSpring).
class SpatialCoordinate final : public RelativeCoordinate {
 public:
  SpatialCoordinate(SpatialMarker first, SpatialMarker second, Of of, double start);
  const std::vector<int>& coordinates() const override { return pair_.coordinates; }
  Value see(const Motion& motion) override;
  void add(double force, Eigen::VectorXd& r) override;
  void add_tangent(double force, double by_x, double by_rate, Weights weights, Eigen::MatrixXd& J) override;
  void add_gradient(bool of_rate, Eigen::VectorXd& by_q, Eigen::VectorXd& by_v) override;
  Wrench on_second(double force) const override;
  void begin_step(const Motion& motion) override;
  void save(std::vector<double>& carried) const override { revolutions_.save(carried); }
  std::span<const double> load(std::span<const double> carried) override { return revolutions_.load(carried); }

 private:
  SpatialPair pair_;
  Of of_;
  double start_;
  Revolutions revolutions_;
  Vector12 gradient_ = Vector12::Zero(), velocity_ = Vector12::Zero();
  Matrix12 by_motion_ = Matrix12::Zero();  // change of the gradient with the virtual motions
};

}  // namespace floe::dynamics
