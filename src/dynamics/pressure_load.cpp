#include "floe/dynamics/pressure_load.h"

namespace floe::dynamics {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using math::skew;

namespace {

/// int c x f of X = int c f'.
Vector3d axial(const Matrix3d& X) { return {X(1, 2) - X(2, 1), X(2, 0) - X(0, 2), X(0, 1) - X(1, 0)}; }

}  // namespace

PressureLoad::PressureLoad(std::vector<int> coordinates, std::shared_ptr<const Attitude> attitude,
                           body::Pressure pressure, std::function<double(double)> value, Kind kind,
                           const Matrix3d& start)
    : coordinates_(std::move(coordinates)),
      attitude_(std::move(attitude)),
      unit_(std::move(pressure)),
      value_(std::move(value)),
      kind_(kind),
      start_(start) {}

Matrix3d PressureLoad::spread(const Motion& motion) const {
  Matrix3d C = unit_.spread;
  for (Index j = 0; j < unit_.coordinates(); ++j) C += motion.q[frame() + j] * unit_.spread_by[j];
  return C;
}

void PressureLoad::residual(const Motion& motion, Eigen::VectorXd& r) const {
  const double p = value_(motion.t);
  const Index k = unit_.coordinates();
  const auto e = motion.q.tail(k);
  const Matrix3d A = attitude_ ? attitude_->axes(motion.q.segment<3>(3)) : start_;
  if (kind_ == Kind::follower) {
    r.tail(k) -= p * (unit_.load + unit_.load_by * e);
    if (!attitude_) return;
    r.head<3>() -= p * (A * (unit_.force + unit_.force_by * e));
    r.segment<3>(3) -= p * (unit_.moment + unit_.moment_by * e);
    return;
  }
  const Matrix3d B = A.transpose() * start_;
  for (Index j = 0; j < k; ++j) r[frame() + j] -= p * unit_.spread_by[j].cwiseProduct(B).sum();
  if (!attitude_) return;
  r.head<3>() -= p * (start_ * unit_.force);
  r.segment<3>(3) -= p * axial(spread(motion) * B.transpose());
}

void PressureLoad::tangent(const Motion& motion, Weights weights, Eigen::MatrixXd& J) const {
  const double p = weights.q * value_(motion.t);
  const Index k = unit_.coordinates();
  if (kind_ == Kind::dead) {
    if (attitude_) add_dead_tangent(motion, p, J);
    return;
  }
  J.bottomRightCorner(k, k) -= p * unit_.load_by;
  if (!attitude_) return;
  const Vector3d x = motion.q.segment<3>(3), force = unit_.force + unit_.force_by * motion.q.tail(k);
  const Matrix3d A = attitude_->axes(x);
  J.block<3, 3>(0, 3) += p * A * skew(force) * math::rotation_tangent(x);
  J.topRightCorner(3, k) -= p * A * unit_.force_by;
  J.block(3, 6, 3, k) -= p * unit_.moment_by;
}

/// A rotation by w = T(x) dx in body axes changes B by -~w B.
void PressureLoad::add_dead_tangent(const Motion& motion, double p, Eigen::MatrixXd& J) const {
  const Index k = unit_.coordinates();
  const Vector3d x = motion.q.segment<3>(3);
  const Matrix3d B = attitude_->axes(x).transpose() * start_, C = spread(motion), T = math::rotation_tangent(x);
  Eigen::MatrixXd by_rotation(3 + k, 3);
  for (int i = 0; i < 3; ++i) {
    const Matrix3d dB = -skew(Vector3d::Unit(i)) * B;
    by_rotation.col(i).head<3>() = axial(C * dB.transpose());
    for (Index j = 0; j < k; ++j) by_rotation(3 + j, i) = unit_.spread_by[j].cwiseProduct(dB).sum();
  }
  J.block(3, 3, 3 + k, 3) -= p * by_rotation * T;
  for (Index j = 0; j < k; ++j) J.block<3, 1>(3, 6 + j) -= p * axial(unit_.spread_by[j] * B.transpose());
}

}  // namespace floe::dynamics
