#pragma once
#include <array>

#include "floe/dynamics/marker_pair.h"
#include "floe/dynamics/spatial_pair.h"

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

  /// On x: r += force; its derivatives; the energy that the spring holds.
  struct Value {
    double force = 0, by_x = 0, by_rate = 0, energy = 0;
  };
  Value at(double x, double rate) const;
};

/// Stops of a joint's free coordinate, in the plane or in space.
class Stop : public Connection {
 public:
  explicit Stop(StopLaw law) : law_(law) {}
  const StopLaw& law() const { return law_; }
  /// The coordinate, since the start. [rad], [m]
  virtual double position(const Motion& motion) const = 0;
  /// Its rate. [rad/s], [m/s]
  virtual double rate(const Motion& motion) const = 0;

 private:
  StopLaw law_;
};

/// In the plane: x = angle_2 - angle_1 - start, or x = e.(p_2 - p_1) - start with e carried by the first place.
class PlanarStop final : public Stop {
 public:
  /// @param along  e at angle_1 = 0; zero: the stop is one of the turn
  PlanarStop(Marker first, Marker second, Eigen::Vector2d along, double start, StopLaw law);
  const std::vector<int>& coordinates() const override { return pair_.coordinates; }
  void residual(const Motion& motion, Eigen::VectorXd& r) const override;
  void tangent(const Motion& motion, Weights weights, Eigen::MatrixXd& J) const override;
  Energy energy(const Motion& motion) const override;
  Wrench on_second(const Motion& motion) const override;
  double position(const Motion& motion) const override;
  double rate(const Motion& motion) const override;

 private:
  struct Seen;
  Seen see(const Motion& motion) const;
  mutable MarkerPair pair_;
  Eigen::Vector2d along_;
  double start_;
};

/// In space, with z the joint's axis: x = phi, the twist of D1'D2 about z (as of SpatialSpring), or
/// x = D1_z.(p_2 - p_1) - start.
class SpatialStop final : public Stop {
 public:
  enum class Of { turn, slide };
  SpatialStop(SpatialMarker first, SpatialMarker second, Of of, double start, StopLaw law);
  const std::vector<int>& coordinates() const override { return pair_.coordinates; }
  void residual(const Motion& motion, Eigen::VectorXd& r) const override;
  void tangent(const Motion& motion, Weights weights, Eigen::MatrixXd& J) const override;
  Energy energy(const Motion& motion) const override;
  Wrench on_second(const Motion& motion) const override;
  double position(const Motion& motion) const override;
  double rate(const Motion& motion) const override;
  /// Counts turns, as SpatialSpring does.
  void begin_step(const Motion& motion) override;
  void save(std::vector<double>& carried) const override { carried.push_back(nearest_); }
  void load(std::span<const double> carried) override { nearest_ = carried.front(); }

 private:
  struct Seen;
  Seen see(const Motion& motion) const;
  mutable SpatialPair pair_;
  Of of_;
  double start_, nearest_ = 0;
};

}  // namespace floe::dynamics
