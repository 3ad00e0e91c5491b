#include "floe/dynamics/spatial_force.h"

#include "floe/dynamics/local_indices.h"
#include "seen_axes.h"

namespace floe::dynamics {

using Eigen::Matrix3d;
using math::skew;

SpatialForce::SpatialForce(SpatialMarker at, std::function<Wrench(double)> wrench, Axes axes)
    : at_(std::move(at)), wrench_(std::move(wrench)), axes_(axes), coordinates_(at_.coordinates) {}

SpatialForce::SpatialForce(SpatialMarker at, std::function<Wrench(double)> wrench, const MovingAxes& other)
    : SpatialForce(std::move(at), std::move(wrench), Axes::other) {
  other_ = other;
  place_all(other.coordinates(), coordinates_);
}

Wrench SpatialForce::world(const Motion& motion) const {
  Wrench w = wrench_(motion.t);
  if (axes_ == Axes::world) return w;
  const Matrix3d axes = axes_ == Axes::body    ? pose_.A
                        : axes_ == Axes::place ? pose_.D
                                               : see(other_, coordinates_, motion).A;
  return (Wrench() << axes * w.head<3>(), axes * w.tail<3>()).finished();
}

void SpatialForce::residual(const Motion& motion, Eigen::VectorXd& r) const {
  pose(at_, motion.q, motion.v, motion.a, pose_, EvaluationLevel::position);
  pull_back(at_, pose_, world(motion), rows_);
  r.head(rows_.size()) -= rows_;
}

void SpatialForce::tangent(const Motion& motion, Weights weights, Eigen::MatrixXd& J) const {
  pose(at_, motion.q, motion.v, motion.a, pose_, EvaluationLevel::jacobian);
  const Wrench w = world(motion);
  add_geometric_stiffness(at_, pose_, w, -weights.q, J);
  // the wrench rotates by dphi with its axes: dw = -~w dphi
  const Eigen::Matrix<double, 6, 3> rotating =
      weights.q * (Eigen::Matrix<double, 6, 3>() << skew(w.head<3>()), skew(w.tail<3>())).finished();
  if (axes_ == Axes::body && at_.framed()) {
    const Eigen::Matrix<double, 6, 3> by_x = rotating * pose_.A * pose_.T;
    J.middleCols<3>(3) += pose_.P.transpose().lazyProduct(by_x);
  }
  if (axes_ == Axes::place) {
    change_.noalias() = rotating * pose_.P.bottomRows<3>();
    if (at_.framed()) change_.middleCols<3>(3) = (change_.middleCols<3>(3) * pose_.T).eval();
    J += pose_.P.transpose().lazyProduct(change_);
  }
  if (axes_ == Axes::other) {
    const SeenAxes f = see(other_, coordinates_, motion);
    J.block(0, f.o, pose_.P.cols(), f.n) += pose_.P.transpose() * (rotating * f.E * f.T);
  }
}

Energy SpatialForce::energy(const Motion& motion) const {
  if (!conservative) return {};
  pose(at_, motion.q, motion.v, motion.a, pose_, EvaluationLevel::position);
  return {0, 0, -world(motion).head<3>().dot(pose_.p)};
}

}  // namespace floe::dynamics
