#pragma once
#include <memory>

#include "floe/dynamics/relative_coordinate.h"

namespace floe::dynamics {

/// A number of the motion that loads depend on.
class Sensor {
 public:
  virtual ~Sensor() = default;
  virtual const std::vector<int>& coordinates() const = 0;
  virtual double value(const Motion& motion) const = 0;
  /// Adds its derivatives by the coordinates at fixed velocities, and by the velocities (for angular velocities of
  /// frames these themselves).
  virtual void add_gradient(const Motion& motion, Eigen::VectorXd& by_q, Eigen::VectorXd& by_v) const = 0;
  /// As of Term; `load` returns what it leaves over.
  virtual void begin_step(const Motion&) {}
  virtual void save(std::vector<double>&) const {}
  virtual std::span<const double> load(std::span<const double> carried) { return carried; }
};

/// A relative coordinate, or its rate: also a component of a place's position or velocity, as seen from another one.
class CoordinateSensor final : public Sensor {
 public:
  CoordinateSensor(std::unique_ptr<RelativeCoordinate> of, bool rate) : of_(std::move(of)), rate_(rate) {}
  const std::vector<int>& coordinates() const override { return of_->coordinates(); }
  double value(const Motion& motion) const override;
  void add_gradient(const Motion& motion, Eigen::VectorXd& by_q, Eigen::VectorXd& by_v) const override;
  void begin_step(const Motion& motion) override { of_->begin_step(motion); }
  void save(std::vector<double>& carried) const override { of_->save(carried); }
  std::span<const double> load(std::span<const double> carried) override { return of_->load(carried); }

 private:
  std::unique_ptr<RelativeCoordinate> of_;
  bool rate_;
};

/// A component, in axes of the first place, of the second place's rotation vector or angular velocity against it:
///
///   rho_i,  exp(~rho) = D1'D2,  |rho| <= pi;   or   (D1'(w_2 - w_1))_i
class SpatialRotationSensor final : public Sensor {
 public:
  SpatialRotationSensor(SpatialMarker first, SpatialMarker second, int component, bool rate)
      : pair_(std::move(first), std::move(second)), component_(component), rate_(rate) {}
  const std::vector<int>& coordinates() const override { return pair_.coordinates; }
  double value(const Motion& motion) const override;
  void add_gradient(const Motion& motion, Eigen::VectorXd& by_q, Eigen::VectorXd& by_v) const override;

 private:
  mutable SpatialPair pair_;
  int component_;
  bool rate_;
};

}  // namespace floe::dynamics
