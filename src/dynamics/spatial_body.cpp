#include "floe/dynamics/spatial_body.h"

namespace floe::dynamics {

SpatialBody::SpatialBody(std::vector<int> coordinates, std::shared_ptr<const Attitude> attitude,
                         body::SpatialInertia inertia, body::Elasticity elasticity, Eigen::MatrixXd damping)
    : coordinates_(std::move(coordinates)),
      attitude_(std::move(attitude)),
      inertia_(std::move(inertia)),
      elasticity_(std::move(elasticity)),
      damping_(std::move(damping)) {}

void SpatialBody::residual(const Motion& motion, Eigen::VectorXd& r) const {
  body::add_spatial_inertia_force(inertia_, axes(motion), motion.q, motion.v, motion.a, inertia_work_, r);
  const Eigen::Index k = r.size() - 6;
  elastic_ = motion.q.tail(k);
  body::add_force(elasticity_, elastic_, elasticity_work_, r.tail(k));
  if (damping_.size() > 0) r.tail(k).noalias() += damping_ * motion.v.tail(k);
}

void SpatialBody::tangent(const Motion& motion, Weights weights, Eigen::MatrixXd& J) const {
  body::add_spatial_inertia_tangent(inertia_, axes(motion), motion.q, motion.v, motion.a, weights.q, weights.v,
                                    weights.a, inertia_work_, J);
  const Eigen::Index k = J.rows() - 6;
  elastic_ = motion.q.tail(k);
  if (weights.q != 0) body::add_tangent(elasticity_, elastic_, weights.q, elasticity_work_, J.bottomRightCorner(k, k));
  if (damping_.size() > 0) J.bottomRightCorner(k, k) += weights.v * damping_;
}

Energy SpatialBody::energy(const Motion& motion) const {
  elastic_ = motion.q.tail(motion.q.size() - 6);
  return {body::kinetic_energy(inertia_, axes(motion), motion.q, motion.v), body::energy(elasticity_, elastic_), 0};
}

body::Momentum SpatialBody::momentum(const Motion& motion) const {
  return body::momentum(inertia_, axes(motion), motion.q, motion.v);
}

}  // namespace floe::dynamics
