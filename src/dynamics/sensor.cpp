#include "floe/dynamics/sensor.h"

#include "floe/math/rotation.h"

namespace floe::dynamics {

using Eigen::Matrix3d;
using Eigen::Vector3d;

double CoordinateSensor::value(const Motion& motion) const {
  const auto [x, rate] = of_->see(motion);
  return rate_ ? rate : x;
}

void CoordinateSensor::add_gradient(const Motion& motion, Eigen::VectorXd& by_q, Eigen::VectorXd& by_v) const {
  of_->see(motion);
  of_->add_gradient(rate_, by_q, by_v);
}

namespace {

Vector3d rotation_between(const SpatialPair& pair) {
  return math::rotation_vector(Eigen::Quaterniond(Matrix3d(pair.pose[0].D.transpose() * pair.pose[1].D)).normalized());
}

}  // namespace

double SpatialRotationSensor::value(const Motion& motion) const {
  pair_.evaluate(motion, rate_ ? EvaluationLevel::velocity : EvaluationLevel::position);
  if (!rate_) return rotation_between(pair_)[component_];
  return pair_.pose[0].D.col(component_).dot(pair_.pose[1].spin - pair_.pose[0].spin);
}

void SpatialRotationSensor::add_gradient(const Motion& motion, Eigen::VectorXd& by_q, Eigen::VectorXd& by_v) const {
  pair_.evaluate(motion, rate_ ? EvaluationLevel::velocity : EvaluationLevel::jacobian);
  const Matrix3d& D = pair_.pose[0].D;
  Vector12 gradient = Vector12::Zero();
  if (!rate_) {  // rho. = T(rho)'^-1 D1'(w_2 - w_1)
    const Vector3d h = D * math::rotation_tangent(rotation_between(pair_)).inverse().col(component_);
    gradient.segment<3>(3) = -h, gradient.segment<3>(9) = h;
    return pair_.add_gradient(gradient, by_q);
  }
  const Vector3d e = D.col(component_), slip = pair_.pose[1].spin - pair_.pose[0].spin;
  gradient.segment<3>(3) = e.cross(slip);  // de = dphi_1 x e
  pair_.add_gradient(gradient, by_q);
  gradient.segment<3>(3) = -e, gradient.segment<3>(9) = e;
  pair_.add_rate_gradient(gradient, by_q);
  pair_.add(gradient, by_v);
}

}  // namespace floe::dynamics
