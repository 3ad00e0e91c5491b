#include "floe/dynamics/joint_force.h"

#include <cmath>

namespace floe::dynamics {

void JointForce::residual(const Motion& motion, Eigen::VectorXd& r) const {
  if (!is_active()) return;
  const auto [x, rate] = of_->see(motion);
  const double force = law_(x, rate).force;
  if (force != 0) of_->add(force, r);
}

void JointForce::tangent(const Motion& motion, Weights weights, Eigen::MatrixXd& J) const {
  if (!is_active()) return;
  const auto [x, rate] = of_->see(motion);
  const ForceOnCoordinate on = law_(x, rate);
  if (on.force != 0 || on.by_x != 0 || on.by_rate != 0) of_->add_tangent(on.force, on.by_x, on.by_rate, weights, J);
}

Energy JointForce::energy(const Motion& motion) const {
  if (!is_active()) return {};
  const auto [x, rate] = of_->see(motion);
  return {0, law_(x, rate).energy, 0};
}

Wrench JointForce::on_second(const Motion& motion) const {
  if (!is_active()) return Wrench::Zero();
  const auto [x, rate] = of_->see(motion);
  return of_->on_second(-law_(x, rate).force);
}

ForceOnCoordinate FrictionLaw::operator()(double, double rate) const {
  const double share = std::tanh(rate / speed);
  return {level * share + viscosity * rate, 0, level * (1 - share * share) / speed + viscosity, 0};
}

}  // namespace floe::dynamics
