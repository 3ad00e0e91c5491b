#include "floe/dynamics/fixed_frame_body.h"

namespace floe::dynamics {

FixedFrameBody::FixedFrameBody(std::vector<int> coordinates, Eigen::MatrixXd mass, body::Elasticity elasticity,
                               Eigen::MatrixXd damping)
    : coordinates_(std::move(coordinates)),
      mass_(std::move(mass)),
      damping_(std::move(damping)),
      elasticity_(std::move(elasticity)) {}

void FixedFrameBody::residual(const Motion& motion, Eigen::VectorXd& r) const {
  r.noalias() += mass_ * motion.a;
  body::add_force(elasticity_, motion.q, work_, r);
  if (damping_.size() > 0) r.noalias() += damping_ * motion.v;
}

void FixedFrameBody::tangent(const Motion& motion, Weights weights, Eigen::MatrixXd& J) const {
  J += weights.a * mass_;
  if (weights.q != 0) body::add_tangent(elasticity_, motion.q, weights.q, work_, J);
  if (damping_.size() > 0) J += weights.v * damping_;
}

Energy FixedFrameBody::energy(const Motion& motion) const {
  return {0.5 * motion.v.dot(mass_ * motion.v), body::energy(elasticity_, motion.q), 0};
}

DeadForce::DeadForce(std::vector<int> coordinates, Eigen::MatrixXd S, std::function<Eigen::VectorXd(double)> force,
                     std::vector<Eigen::MatrixXd> Q)
    : coordinates_(std::move(coordinates)), S_(std::move(S)), force_(std::move(force)), Q_(std::move(Q)) {}

void DeadForce::residual(const Motion& motion, Eigen::VectorXd& r) const {
  const Eigen::VectorXd force = force_(motion.t);
  r.noalias() -= S_.transpose() * force;
  for (std::size_t a = 0; a < Q_.size(); ++a) r.noalias() -= force[static_cast<Eigen::Index>(a)] * (Q_[a] * motion.q);
}

void DeadForce::tangent(const Motion& motion, Weights weights, Eigen::MatrixXd& J) const {
  if (Q_.empty() || weights.q == 0) return;
  const Eigen::VectorXd force = force_(motion.t);
  for (std::size_t a = 0; a < Q_.size(); ++a) J -= weights.q * force[static_cast<Eigen::Index>(a)] * Q_[a];
}

Energy DeadForce::energy(const Motion& motion) const {
  if (!conservative) return {};
  const Eigen::VectorXd force = force_(motion.t);
  double work = force.dot(S_ * motion.q);
  for (std::size_t a = 0; a < Q_.size(); ++a)
    work += 0.5 * force[static_cast<Eigen::Index>(a)] * motion.q.dot(Q_[a] * motion.q);
  return {0, 0, -work};
}

}  // namespace floe::dynamics
