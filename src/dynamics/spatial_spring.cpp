#include "floe/dynamics/spatial_spring.h"

#include "spatial_twist.h"

namespace floe::dynamics {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

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

double moment(const SpatialSpringProperties& p, const Twist& t) {
  return p.torsional_stiffness * (t.angle - p.angle - p.rest) + p.torsional_viscosity * t.rate;
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

void add_torsion(const SpatialSpringProperties& p, const Twist& t, Matrix12& Y, Matrix12& Yd) {
  for (int j = 0; j < 2; ++j) {
    const double sign = j == 0 ? -1 : 1;
    const Eigen::RowVector3d of_moment =
        sign * p.torsional_stiffness * t.h.transpose() + p.torsional_viscosity * t.slip.transpose() * t.by_rotation[j];
    const Matrix3d of_place = t.h * of_moment + moment(p, t) * t.by_rotation[j],
                   of_spin = sign * p.torsional_viscosity * t.h * t.h.transpose();
    Y.block<3, 3>(9, 6 * j + 3) += of_place, Y.block<3, 3>(3, 6 * j + 3) -= of_place;
    Yd.block<3, 3>(9, 6 * j + 3) += of_spin, Yd.block<3, 3>(3, 6 * j + 3) -= of_spin;
  }
}

}  // namespace

SpatialSpring::SpatialSpring(SpatialMarker first, SpatialMarker second, SpatialSpringProperties properties)
    : pair_(std::move(first), std::move(second)), properties_(properties), revolutions_(properties.angle) {}

void SpatialSpring::residual(const Motion& motion, Eigen::VectorXd& r) const {
  pair_.evaluate(motion);
  pair_.add(wrench_of(properties_, pair_, revolutions_.expected(motion.t)), r);
}

Wrench SpatialSpring::on_second(const Motion& motion) const {
  pair_.evaluate(motion);
  return -wrench_of(properties_, pair_, revolutions_.expected(motion.t)).tail<6>();
}

void SpatialSpring::tangent(const Motion& motion, Weights weights, Eigen::MatrixXd& J) const {
  pair_.evaluate(motion);
  Matrix12 Y = Matrix12::Zero(), Yd = Matrix12::Zero();
  add_line(properties_, line(pair_), Y, Yd);
  if (torsional(properties_)) add_torsion(properties_, twist(pair_, revolutions_.expected(motion.t)), Y, Yd);
  pair_.add_tangent(wrench_of(properties_, pair_, revolutions_.expected(motion.t)), Y, Yd, weights, J);
}

Energy SpatialSpring::energy(const Motion& motion) const {
  pair_.evaluate(motion);
  const SpatialSpringProperties& p = properties_;
  const double stretch = line(pair_).length - p.length;
  const double rotated = torsional(p) ? twist(pair_, revolutions_.expected(motion.t)).angle - p.angle - p.rest : 0;
  return {0, 0.5 * p.stiffness * stretch * stretch + 0.5 * p.torsional_stiffness * rotated * rotated, 0};
}

void SpatialSpring::begin_step(const Motion& motion) {
  if (!torsional(properties_)) return;
  pair_.evaluate(motion);
  begin(revolutions_, pair_, motion.t);
}

}  // namespace floe::dynamics
