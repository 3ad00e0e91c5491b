#include "floe/dynamics/spatial_spring.h"

#include <cmath>

#include "floe/error.h"

namespace floe::dynamics {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using math::skew;

/// Line of action: its length, direction and lengthening rate. Coinciding places have no direction.
struct Line {
  double length, rate;
  Vector3d n, gap_rate;
};

Line line(const SpatialPair& pair) {
  const Vector3d d = pair.pose[1].p - pair.pose[0].p, rate = pair.pose[1].velocity - pair.pose[0].velocity;
  const double length = d.norm();
  const Vector3d n = length > 0 ? Vector3d(d / length) : Vector3d::Zero();
  return {length, n.dot(rate), n, rate};
}

double tension(const SpatialSpringProperties& p, const Line& l) {
  return p.stiffness * (l.length - p.length) + p.viscosity * l.rate;
}

bool torsional(const SpatialSpringProperties& p) { return p.torsional_stiffness != 0 || p.torsional_viscosity != 0; }

/// Twist of the second place against the first about z: angle (the one nearest to `nearest`), h, and its rate.
struct Twist {
  double angle, rate;
  Vector3d h, slip;  ///< slip = w_2 - w_1
};

Twist twist(const SpatialPair& pair, double nearest) {
  const Matrix3d &one = pair.pose[0].D, &two = pair.pose[1].D;
  const double aligned = 1 + one.col(2).dot(two.col(2));
  if (!(aligned > 1e-12)) throw RunError("a torsional spring has the z axes of its places opposite to each other");
  const double sine = one.col(1).dot(two.col(0)) - one.col(0).dot(two.col(1)),
               cosine = one.col(0).dot(two.col(0)) + one.col(1).dot(two.col(1));
  const Vector3d h = (one.col(2) + two.col(2)) / aligned, slip = pair.pose[1].spin - pair.pose[0].spin;
  return {nearest + std::remainder(std::atan2(sine, cosine) - nearest, 2 * M_PI), h.dot(slip), h, slip};
}

double moment(const SpatialSpringProperties& p, const Twist& t) {
  return p.torsional_stiffness * (t.angle - p.angle) + p.torsional_viscosity * t.rate;
}

Vector12 wrench_of(const SpatialSpringProperties& p, const SpatialPair& pair, double nearest) {
  const Line l = line(pair);
  const Vector3d f = tension(p, l) * l.n;
  Vector3d m = Vector3d::Zero();
  if (torsional(p)) {
    const Twist t = twist(pair, nearest);
    m = moment(p, t) * t.h;
  }
  return (Vector12() << -f, -m, f, m).finished();
}

void add_line(const SpatialSpringProperties& p, const Line& l, Matrix12& Y, Matrix12& Yd) {
  const Matrix3d along = l.n * l.n.transpose();
  Matrix3d K = p.stiffness * along;
  if (l.length > 0) {
    const Matrix3d across = (Matrix3d::Identity() - along) / l.length;
    const Vector3d slip = across * l.gap_rate;  // dn/dt
    K += tension(p, l) * across + p.viscosity * l.n * slip.transpose();
  } else if (p.length == 0) {
    K = p.stiffness * Matrix3d::Identity();  // f = stiffness (p_2 - p_1)
  }
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j) {
      const double sign = i == j ? 1 : -1;
      Y.block<3, 3>(6 * i, 6 * j) += sign * K;
      Yd.block<3, 3>(6 * i, 6 * j) += sign * p.viscosity * along;
    }
}

void add_torsion(const SpatialSpringProperties& p, const SpatialPair& pair, const Twist& t, Matrix12& Y, Matrix12& Yd) {
  const Vector3d one = pair.pose[0].D.col(2), two = pair.pose[1].D.col(2);
  const double aligned = 1 + one.dot(two);
  const Matrix3d shared = t.h * one.cross(two).transpose() / aligned;
  // dh = H_1 dphi_1 + H_2 dphi_2
  const Matrix3d H[2] = {-skew(one) / aligned - shared, -skew(two) / aligned + shared};
  for (int j = 0; j < 2; ++j) {
    const double sign = j == 0 ? -1 : 1;
    const Eigen::RowVector3d of_moment =
        sign * p.torsional_stiffness * t.h.transpose() + p.torsional_viscosity * t.slip.transpose() * H[j];
    const Matrix3d of_place = t.h * of_moment + moment(p, t) * H[j],
                   of_spin = sign * p.torsional_viscosity * t.h * t.h.transpose();
    Y.block<3, 3>(9, 6 * j + 3) += of_place, Y.block<3, 3>(3, 6 * j + 3) -= of_place;
    Yd.block<3, 3>(9, 6 * j + 3) += of_spin, Yd.block<3, 3>(3, 6 * j + 3) -= of_spin;
  }
}

}  // namespace

SpatialSpring::SpatialSpring(SpatialMarker first, SpatialMarker second, SpatialSpringProperties properties)
    : pair_(std::move(first), std::move(second)), properties_(properties), nearest_(properties.angle) {}

void SpatialSpring::residual(const Motion& motion, Eigen::VectorXd& r) const {
  pair_.evaluate(motion);
  pair_.add(wrench_of(properties_, pair_, nearest_), r);
}

void SpatialSpring::tangent(const Motion& motion, Weights weights, Eigen::MatrixXd& J) const {
  pair_.evaluate(motion);
  Matrix12 Y = Matrix12::Zero(), Yd = Matrix12::Zero();
  add_line(properties_, line(pair_), Y, Yd);
  if (torsional(properties_)) add_torsion(properties_, pair_, twist(pair_, nearest_), Y, Yd);
  pair_.add_tangent(wrench_of(properties_, pair_, nearest_), Y, Yd, weights, J);
}

Energy SpatialSpring::energy(const Motion& motion) const {
  pair_.evaluate(motion);
  const SpatialSpringProperties& p = properties_;
  const double stretch = line(pair_).length - p.length;
  const double turned = torsional(p) ? twist(pair_, nearest_).angle - p.angle : 0;
  return {0, 0.5 * p.stiffness * stretch * stretch + 0.5 * p.torsional_stiffness * turned * turned, 0};
}

void SpatialSpring::begin_step(const Motion& motion) {
  if (!torsional(properties_)) return;
  pair_.evaluate(motion);
  nearest_ = twist(pair_, nearest_).angle;
}

}  // namespace floe::dynamics
