#include "floe/dynamics/relative_coordinate.h"

#include <cmath>

#include "floe/error.h"
#include "spatial_twist.h"

namespace floe::dynamics {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using math::skew;

namespace {

[[noreturn]] void refuse_length() { throw RunError("the two places of a length coincide; its direction is undefined"); }

}  // namespace

PlanarCoordinate::PlanarCoordinate(Marker first, Marker second, Of of, double start, Vector2d along)
    : pair_(std::move(first), std::move(second)), of_(of), start_(start), along_(std::move(along)) {}

RelativeCoordinate::Value PlanarCoordinate::see(const Motion& motion) {
  pair_.evaluate(motion);
  const Vector6 y = pair_.y();
  const Vector2d d = y.segment<2>(3) - y.head<2>();
  double x = -start_;
  yd_ = pair_.yd();
  switch (of_) {
    case Of::rotation:
      x += y[5] - y[2];
      gradient_[2] = -1, gradient_[5] = 1;
      break;
    case Of::slide: {
      const double c = std::cos(y[2]), s = std::sin(y[2]);
      const Vector2d e(c * along_.x() - s * along_.y(), s * along_.x() + c * along_.y()), n(-e.y(), e.x());
      x += e.dot(d);
      gradient_ << -e, n.dot(d), e, 0;
      hessian_(2, 2) = -e.dot(d);
      hessian_.block<2, 1>(0, 2) = -n, hessian_.block<1, 2>(2, 0) = -n.transpose();
      hessian_.block<2, 1>(3, 2) = n, hessian_.block<1, 2>(2, 3) = n.transpose();
      break;
    }
    case Of::length: {
      const double length = d.norm();
      if (length == 0) refuse_length();
      const Vector2d u = d / length;
      x += length;
      gradient_ << -u, 0, u, 0;
      const Eigen::Matrix2d across = (Eigen::Matrix2d::Identity() - u * u.transpose()) / length;
      for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j) hessian_.block<2, 2>(3 * i, 3 * j) = i == j ? across : -across;
    }
  }
  return {x, gradient_.dot(yd_)};
}

void PlanarCoordinate::add(double force, Eigen::VectorXd& r) { pair_.add(force * gradient_, r); }

void PlanarCoordinate::add_tangent(double force, double by_x, double by_rate, Weights weights, Eigen::MatrixXd& J) {
  const Matrix6 Y = gradient_ * (by_x * gradient_ + by_rate * hessian_ * yd_).transpose() + force * hessian_;
  pair_.add_tangent(force * gradient_, Y, by_rate * gradient_ * gradient_.transpose(), weights, J);
}

void PlanarCoordinate::add_gradient(bool of_rate, Eigen::VectorXd& by_q, Eigen::VectorXd& by_v) {
  if (!of_rate) return pair_.add(gradient_, by_q);
  pair_.add(hessian_ * yd_, by_q);
  pair_.add_rate_gradient(gradient_, by_q);
  pair_.add(gradient_, by_v);
}

Wrench PlanarCoordinate::on_second(double force) const { return on_second_place(-force * gradient_); }

SpatialCoordinate::SpatialCoordinate(SpatialMarker first, SpatialMarker second, Of of, double start)
    : pair_(std::move(first), std::move(second)), of_(of), start_(start) {}

RelativeCoordinate::Value SpatialCoordinate::see(const Motion& motion) {
  pair_.evaluate(motion);
  const SpatialPose &one = pair_.pose[0], &two = pair_.pose[1];
  const Vector3d d = two.p - one.p;
  double x = -start_;
  velocity_ << one.velocity, one.spin, two.velocity, two.spin;
  switch (of_) {
    case Of::rotation: {
      const Twist t = twist(pair_, revolutions_.expected(motion.t));
      x += t.angle;
      gradient_.segment<3>(3) = -t.h, gradient_.segment<3>(9) = t.h;
      for (int j = 0; j < 2; ++j) {
        by_motion_.block<3, 3>(3, 6 * j + 3) = -t.by_rotation[j];
        by_motion_.block<3, 3>(9, 6 * j + 3) = t.by_rotation[j];
      }
      break;
    }
    case Of::slide: {
      const Vector3d z = one.D.col(2);
      const Matrix3d rotated = -skew(z);  // dz = rotated dphi_1
      x += z.dot(d);
      gradient_ << -z, z.cross(d), z, Vector3d::Zero();
      by_motion_.block<3, 3>(0, 3) = -rotated, by_motion_.block<3, 3>(6, 3) = rotated;
      by_motion_.block<3, 3>(3, 3) = -skew(d) * rotated;
      by_motion_.block<3, 3>(3, 0) = -skew(z), by_motion_.block<3, 3>(3, 6) = skew(z);
      break;
    }
    case Of::length: {
      const double length = d.norm();
      if (length == 0) refuse_length();
      const Vector3d u = d / length;
      x += length;
      gradient_ << -u, Vector3d::Zero(), u, Vector3d::Zero();
      const Matrix3d across = (Matrix3d::Identity() - u * u.transpose()) / length;
      for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j) by_motion_.block<3, 3>(6 * i, 6 * j) = i == j ? across : Matrix3d(-across);
    }
  }
  return {x, gradient_.dot(velocity_)};
}

void SpatialCoordinate::add(double force, Eigen::VectorXd& r) { pair_.add(force * gradient_, r); }

void SpatialCoordinate::add_tangent(double force, double by_x, double by_rate, Weights weights, Eigen::MatrixXd& J) {
  const Vector12 of_force = by_x * gradient_ + by_rate * by_motion_.transpose() * velocity_;
  const Matrix12 Y = gradient_ * of_force.transpose() + force * by_motion_;
  pair_.add_tangent(force * gradient_, Y, by_rate * gradient_ * gradient_.transpose(), weights, J);
}

void SpatialCoordinate::add_gradient(bool of_rate, Eigen::VectorXd& by_q, Eigen::VectorXd& by_v) {
  if (!of_rate) return pair_.add_gradient(gradient_, by_q);
  pair_.add_gradient(by_motion_.transpose() * velocity_, by_q);
  pair_.add_rate_gradient(gradient_, by_q);
  pair_.add(gradient_, by_v);
}

Wrench SpatialCoordinate::on_second(double force) const { return force * gradient_.tail<6>(); }

void SpatialCoordinate::begin_step(const Motion& motion) {
  if (of_ != Of::rotation) return;
  pair_.evaluate(motion);
  begin(revolutions_, pair_, motion.t);
}

}  // namespace floe::dynamics
