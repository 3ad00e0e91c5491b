#include <cmath>

#include "floe/dynamics/joints.h"

namespace floe::dynamics {

Force::Force(Marker at, std::function<Eigen::Vector3d(double)> force, Axes axes)
    : at_(std::move(at)), force_(std::move(force)), axes_(axes), coordinates_(at_.coordinates) {}

Force::Force(Marker at, std::function<Eigen::Vector3d(double)> force, const MovingAxes& other)
    : Force(std::move(at), std::move(force), Axes::other) {
  angle_ = other.angle;
  coordinates_.push_back(other.rotation);
}

Eigen::Vector3d Force::wrench(const Motion& motion) const {
  Eigen::Vector3d f = force_(motion.t);
  if (axes_ == Axes::place || axes_ == Axes::other || (axes_ == Axes::body && at_.framed)) {
    const double angle = axes_ == Axes::place  ? pose_.y[2]
                         : axes_ == Axes::body ? motion.q[2]
                                               : angle_ + motion.q[motion.q.size() - 1],
                 c = std::cos(angle), s = std::sin(angle);
    f.head<2>() = Eigen::Vector2d(c * f.x() - s * f.y(), s * f.x() + c * f.y());
  }
  return f;
}

void Force::residual(const Motion& motion, Eigen::VectorXd& r) const {
  pose(at_, motion.q, motion.v, motion.a, pose_, EvaluationLevel::position);
  const Eigen::Vector3d f = wrench(motion);
  for (Eigen::Index i = 0; i < pose_.P.cols(); ++i) r[i] -= pose_.P.col(i).dot(f);
}

void Force::tangent(const Motion& motion, Weights weights, Eigen::MatrixXd& J) const {
  pose(at_, motion.q, motion.v, motion.a, pose_, EvaluationLevel::position);
  const Eigen::Vector3d f = wrench(motion);
  add_geometric_stiffness(at_, pose_, f, -weights.q, J);
  if (axes_ == Axes::body && at_.framed)
    J.col(2).noalias() -= weights.q * (pose_.P.transpose() * Eigen::Vector3d(-f.y(), f.x(), 0));
  if (axes_ == Axes::other)
    J.col(J.cols() - 1).head(pose_.P.cols()) -= weights.q * (pose_.P.transpose() * Eigen::Vector3d(-f.y(), f.x(), 0));
  if (axes_ == Axes::place)
    J.noalias() -= weights.q * (pose_.P.transpose() * Eigen::Vector3d(-f.y(), f.x(), 0)) * pose_.P.row(2);
}

Energy Force::energy(const Motion& motion) const {
  if (!conservative) return {};
  pose(at_, motion.q, motion.v, motion.a, pose_, EvaluationLevel::position);
  return {0, 0, -wrench(motion).dot(pose_.y)};
}

}  // namespace floe::dynamics
