#pragma once
#include <functional>
#include <memory>

#include "floe/dynamics/connection.h"
#include "floe/dynamics/event.h"
#include "floe/dynamics/relative_coordinate.h"

namespace floe::dynamics {

/// A force on a relative coordinate x, its derivatives, and the energy that it holds. Positive forces resist: r +=
/// force dx/dq.
struct ForceOnCoordinate {
  double force = 0, by_x = 0, by_rate = 0, energy = 0;
};

/// A force law between the places of a joint.
class JointForce : public Connection {
 public:
  using Law = std::function<ForceOnCoordinate(double x, double rate)>;
  /// @param active  if given, whether the joint's own constraints are; a joint that is released exerts no force
  JointForce(std::unique_ptr<RelativeCoordinate> of, Law law, std::shared_ptr<const ConstraintSwitch> active = {})
      : of_(std::move(of)), law_(std::move(law)), active_(std::move(active)) {}
  const std::vector<int>& coordinates() const override { return of_->coordinates(); }
  void residual(const Motion& motion, Eigen::VectorXd& r) const override;
  void tangent(const Motion& motion, Weights weights, Eigen::MatrixXd& J) const override;
  Energy energy(const Motion& motion) const override;
  Wrench on_second(const Motion& motion) const override;
  /// x and its rate.
  RelativeCoordinate::Value at(const Motion& motion) const { return of_->see(motion); }
  bool is_active() const { return !active_ || active_->closed; }
  void begin_step(const Motion& motion) override {
    if (is_active()) of_->begin_step(motion);
  }
  void save(std::vector<double>& carried) const override { of_->save(carried); }
  void load(std::span<const double> carried) override { of_->load(carried); }

 private:
  std::unique_ptr<RelativeCoordinate> of_;
  Law law_;
  std::shared_ptr<const ConstraintSwitch> active_;
};

/// Coulomb friction, regularised, and viscous friction of a joint:
///
///   force = level tanh(rate / speed) + viscosity rate
///
/// Below `speed` it creeps: a load f < level moves the joint at speed atanh(f / level).
struct FrictionLaw {
  double level = 0;      ///< [N m], [N]
  double viscosity = 0;  ///< [N m s/rad], [N s/m]
  double speed = 1;      ///< > 0 [rad/s], [m/s]
  ForceOnCoordinate operator()(double x, double rate) const;
};

}  // namespace floe::dynamics
