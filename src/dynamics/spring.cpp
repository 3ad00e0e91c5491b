#include <cmath>

#include "floe/dynamics/joints.h"

namespace floe::dynamics {
namespace {

/// Line of action: its length, direction and lengthening rate. Coinciding places have no direction and carry no line
/// force.
struct Line {
  double length, rate;
  Eigen::Vector2d n;
};

Line line(const Vector6& y, const Vector6& yd) {
  const Eigen::Vector2d d = y.segment<2>(3) - y.head<2>();
  const double length = d.norm();
  const Eigen::Vector2d n = length > 0 ? Eigen::Vector2d(d / length) : Eigen::Vector2d::Zero();
  return {length, n.dot(yd.segment<2>(3) - yd.head<2>()), n};
}

Vector6 wrench_of(const SpringProperties& p, const Line& l, const Vector6& y, const Vector6& yd) {
  const Eigen::Vector2d f = (p.stiffness * (l.length - p.length) + p.viscosity * l.rate) * l.n;
  const double m = p.torsional_stiffness * (y[5] - y[2] - p.angle) + p.torsional_viscosity * (yd[5] - yd[2]);
  return (Vector6() << -f, -m, f, m).finished();
}

/// (+A at (1,1) and (2,2), -A across) for the 2 x 2 block of the line and the scalar of the torsion.
void add_pair(const Eigen::Matrix2d& A, double torsion, Matrix6& Y) {
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j) {
      const double sign = i == j ? 1 : -1;
      Y.block<2, 2>(3 * i, 3 * j) += sign * A;
      Y(3 * i + 2, 3 * j + 2) += sign * torsion;
    }
}

}  // namespace

Spring::Spring(Marker first, Marker second, SpringProperties properties)
    : pair_(std::move(first), std::move(second)), properties_(properties) {}

void Spring::residual(const Motion& motion, Eigen::VectorXd& r) const {
  pair_.evaluate(motion);
  const Vector6 y = pair_.y(), yd = pair_.yd();
  pair_.add(wrench_of(properties_, line(y, yd), y, yd), r);
}

Wrench Spring::on_second(const Motion& motion) const {
  pair_.evaluate(motion);
  const Vector6 y = pair_.y(), yd = pair_.yd();
  return on_second_place(wrench_of(properties_, line(y, yd), y, yd));
}

void Spring::tangent(const Motion& motion, Weights weights, Eigen::MatrixXd& J) const {
  pair_.evaluate(motion);
  const Vector6 y = pair_.y(), yd = pair_.yd();
  const SpringProperties& p = properties_;
  const Line l = line(y, yd);
  const Eigen::Matrix2d along = l.n * l.n.transpose();
  Matrix6 Y = Matrix6::Zero(), Yd = Matrix6::Zero();
  Eigen::Matrix2d K = p.stiffness * along;
  if (l.length > 0) {
    const Eigen::Matrix2d across = (Eigen::Matrix2d::Identity() - along) / l.length;
    const double tension = p.stiffness * (l.length - p.length) + p.viscosity * l.rate;
    const Eigen::Vector2d slip = across * (yd.segment<2>(3) - yd.head<2>());  // dn/dt
    K += tension * across + p.viscosity * l.n * slip.transpose();
  }
  add_pair(K, p.torsional_stiffness, Y);
  add_pair(p.viscosity * along, p.torsional_viscosity, Yd);
  pair_.add_tangent(wrench_of(p, l, y, yd), Y, Yd, weights, J);
}

Energy Spring::energy(const Motion& motion) const {
  pair_.evaluate(motion);
  const Vector6 y = pair_.y();
  const double stretch = line(y, pair_.yd()).length - properties_.length;
  const double twist = y[5] - y[2] - properties_.angle;
  return {0, 0.5 * properties_.stiffness * stretch * stretch + 0.5 * properties_.torsional_stiffness * twist * twist,
          0};
}

}  // namespace floe::dynamics
