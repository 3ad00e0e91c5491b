#include "floe/dynamics/stop.h"

#include <cmath>

#include "spatial_twist.h"

namespace floe::dynamics {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using math::skew;

StopLaw::Value StopLaw::at(double x, double rate) const {
  const double sign = x > upper ? 1 : x < lower ? -1 : 0;
  if (sign == 0) return {};
  const double d = sign > 0 ? x - upper : lower - x, s = std::min(d / width, 1.0);
  const double spring = d < width ? stiffness * d * s / 2 : stiffness * (d - width / 2);
  const double share = s * s * (3 - 2 * s), share_by_d = d < width ? 6 * s * (1 - s) / width : 0;
  const double energy = d < width ? stiffness * d * d * s / 6 : stiffness * (d * (d - width) / 2 + width * width / 6);
  return {sign * spring + damping * share * rate, stiffness * s + sign * damping * share_by_d * rate, damping * share,
          energy};
}

struct PlanarStop::Seen {
  double x, rate;
  Vector6 gradient, yd;
  Matrix6 hessian;
};

PlanarStop::PlanarStop(Marker first, Marker second, Vector2d along, double start, StopLaw law)
    : Stop(law), pair_(std::move(first), std::move(second)), along_(std::move(along)), start_(start) {}

PlanarStop::Seen PlanarStop::see(const Motion& motion) const {
  pair_.evaluate(motion);
  const Vector6 y = pair_.y();
  Seen seen{0, 0, Vector6::Zero(), pair_.yd(), Matrix6::Zero()};
  if (along_.isZero(0)) {
    seen.x = y[5] - y[2] - start_;
    seen.gradient[2] = -1, seen.gradient[5] = 1;
  } else {
    const double c = std::cos(y[2]), s = std::sin(y[2]);
    const Vector2d e(c * along_.x() - s * along_.y(), s * along_.x() + c * along_.y()), n(-e.y(), e.x()),
        d = y.segment<2>(3) - y.head<2>();
    seen.x = e.dot(d) - start_;
    seen.gradient << -e, n.dot(d), e, 0;
    seen.hessian(2, 2) = -e.dot(d);
    seen.hessian.block<2, 1>(0, 2) = -n, seen.hessian.block<1, 2>(2, 0) = -n.transpose();
    seen.hessian.block<2, 1>(3, 2) = n, seen.hessian.block<1, 2>(2, 3) = n.transpose();
  }
  seen.rate = seen.gradient.dot(seen.yd);
  return seen;
}

void PlanarStop::residual(const Motion& motion, Eigen::VectorXd& r) const {
  const Seen seen = see(motion);
  const StopLaw::Value stop = law().at(seen.x, seen.rate);
  if (stop.force != 0) pair_.add(stop.force * seen.gradient, r);
}

Wrench PlanarStop::on_second(const Motion& motion) const {
  const Seen seen = see(motion);
  return on_second_place(law().at(seen.x, seen.rate).force * seen.gradient);
}

void PlanarStop::tangent(const Motion& motion, Weights weights, Eigen::MatrixXd& J) const {
  const Seen seen = see(motion);
  const StopLaw::Value stop = law().at(seen.x, seen.rate);
  if (stop.by_x == 0 && stop.force == 0) return;
  const Matrix6 Y = seen.gradient * (stop.by_x * seen.gradient + stop.by_rate * seen.hessian * seen.yd).transpose() +
                    stop.force * seen.hessian;
  pair_.add_tangent(stop.force * seen.gradient, Y, stop.by_rate * seen.gradient * seen.gradient.transpose(), weights,
                    J);
}

Energy PlanarStop::energy(const Motion& motion) const {
  const Seen seen = see(motion);
  return {0, law().at(seen.x, seen.rate).energy, 0};
}

double PlanarStop::position(const Motion& motion) const { return see(motion).x; }
double PlanarStop::rate(const Motion& motion) const { return see(motion).rate; }

/// @note by_motion: change of the gradient with the virtual motions
struct SpatialStop::Seen {
  double x, rate;
  Vector12 gradient, velocity;
  Matrix12 by_motion;
};

SpatialStop::SpatialStop(SpatialMarker first, SpatialMarker second, Of of, double start, StopLaw law)
    : Stop(law), pair_(std::move(first), std::move(second)), of_(of), start_(start) {}

SpatialStop::Seen SpatialStop::see(const Motion& motion) const {
  pair_.evaluate(motion);
  const SpatialPose &one = pair_.pose[0], &two = pair_.pose[1];
  Seen seen{0, 0, Vector12::Zero(), Vector12::Zero(), Matrix12::Zero()};
  seen.velocity << one.velocity, one.spin, two.velocity, two.spin;
  if (of_ == Of::turn) {
    const Twist t = twist(pair_, nearest_);
    seen.x = t.angle - start_;
    seen.gradient.segment<3>(3) = -t.h, seen.gradient.segment<3>(9) = t.h;
    for (int j = 0; j < 2; ++j) {
      seen.by_motion.block<3, 3>(3, 6 * j + 3) = -t.by_turn[j];
      seen.by_motion.block<3, 3>(9, 6 * j + 3) = t.by_turn[j];
    }
  } else {
    const Vector3d z = one.D.col(2), d = two.p - one.p;
    const Matrix3d turned = -skew(z);  // dz = turned dphi_1
    seen.x = z.dot(d) - start_;
    seen.gradient << -z, z.cross(d), z, Vector3d::Zero();
    seen.by_motion.block<3, 3>(0, 3) = -turned, seen.by_motion.block<3, 3>(6, 3) = turned;
    seen.by_motion.block<3, 3>(3, 3) = -skew(d) * turned;
    seen.by_motion.block<3, 3>(3, 0) = -skew(z), seen.by_motion.block<3, 3>(3, 6) = skew(z);
  }
  seen.rate = seen.gradient.dot(seen.velocity);
  return seen;
}

void SpatialStop::residual(const Motion& motion, Eigen::VectorXd& r) const {
  const Seen seen = see(motion);
  const StopLaw::Value stop = law().at(seen.x, seen.rate);
  if (stop.force != 0) pair_.add(stop.force * seen.gradient, r);
}

Wrench SpatialStop::on_second(const Motion& motion) const {
  const Seen seen = see(motion);
  return -law().at(seen.x, seen.rate).force * seen.gradient.tail<6>();
}

void SpatialStop::tangent(const Motion& motion, Weights weights, Eigen::MatrixXd& J) const {
  const Seen seen = see(motion);
  const StopLaw::Value stop = law().at(seen.x, seen.rate);
  if (stop.by_x == 0 && stop.force == 0) return;
  const Vector12 of_force = stop.by_x * seen.gradient + stop.by_rate * seen.by_motion.transpose() * seen.velocity;
  const Matrix12 Y = seen.gradient * of_force.transpose() + stop.force * seen.by_motion;
  pair_.add_tangent(stop.force * seen.gradient, Y, stop.by_rate * seen.gradient * seen.gradient.transpose(), weights,
                    J);
}

Energy SpatialStop::energy(const Motion& motion) const {
  const Seen seen = see(motion);
  return {0, law().at(seen.x, seen.rate).energy, 0};
}

double SpatialStop::position(const Motion& motion) const { return see(motion).x; }
double SpatialStop::rate(const Motion& motion) const { return see(motion).rate; }

void SpatialStop::begin_step(const Motion& motion) {
  if (of_ != Of::turn) return;
  pair_.evaluate(motion);
  nearest_ = twist(pair_, nearest_).angle;
}

}  // namespace floe::dynamics
