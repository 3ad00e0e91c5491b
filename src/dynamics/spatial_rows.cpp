#include "spatial_rows.h"

#include "floe/error.h"

namespace floe::dynamics {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using math::skew;

/// A vector and its first two time derivatives.
struct Moving {
  Vector3d at, rate, acceleration;
};

/// An axis that rotates with given spin and spin rate.
Moving rotating(const Vector3d& axis, const Vector3d& spin, const Vector3d& spin_rate) {
  const Vector3d rate = spin.cross(axis);
  return {axis, rate, spin_rate.cross(axis) + spin.cross(rate)};
}

Moving gap(const SeenPair& pair) {
  return {pair.second.p - pair.first.p, pair.second.velocity - pair.first.velocity,
          pair.second.acceleration - pair.first.acceleration};
}

Moving first_axis(const SeenPair& pair, int axis) {
  return rotating(pair.first.D.col(axis), pair.first.spin, pair.first.spin_rate);
}

/// a.b at a level.
double product(ConstraintLevel level, const Moving& a, const Moving& b) {
  switch (level) {
    case ConstraintLevel::position:
      return a.at.dot(b.at);
    case ConstraintLevel::velocity:
      return a.rate.dot(b.at) + a.at.dot(b.rate);
    case ConstraintLevel::acceleration:
      break;
  }
  return a.acceleration.dot(b.at) + 2 * a.rate.dot(b.rate) + a.at.dot(b.acceleration);
}

double distance(const Vector3d& d) {
  const double length = d.norm();
  if (!(length > 0)) throw RunError("the two places of a distance joint coincide, so that its direction is undefined");
  return length;
}

struct Evaluate {
  const SeenPair& pair;

  RowValue operator()(const PointCoincidence& row) const {
    const Moving d = gap(pair);
    RowValue out;
    out.C = (pair.level == ConstraintLevel::position   ? d.at
             : pair.level == ConstraintLevel::velocity ? d.rate
                                                       : d.acceleration)[row.axis];
    out.gradient[row.axis] = -1, out.gradient[6 + row.axis] = 1;
    return out;
  }
  RowValue operator()(const Along& row) const {
    const Moving d = gap(pair), a = first_axis(pair, row.axis);
    RowValue out;
    out.C = product(pair.level, a, d) - at_level(pair.level, row.position, pair.t);
    if (pair.level == ConstraintLevel::position) out.C -= row.offset;
    out.gradient << -a.at, a.at.cross(d.at), a.at, Vector3d::Zero();
    return out;
  }
  RowValue operator()(const Product& row) const {
    const Moving a = first_axis(pair, row.i),
                 b = rotating(pair.rotated.col(row.j), pair.rotated_spin, pair.rotated_spin_rate);
    const Vector3d normal = a.at.cross(b.at);
    RowValue out;
    out.C = product(pair.level, a, b);
    out.gradient << Vector3d::Zero(), normal, Vector3d::Zero(), -normal;
    return out;
  }
  RowValue operator()(const Separation& row) const {
    const Moving d = gap(pair);
    const double length = distance(d.at);
    const Vector3d n = d.at / length;
    RowValue out;
    if (pair.level == ConstraintLevel::position) out.C = length - row.length;
    if (pair.level == ConstraintLevel::velocity) out.C = n.dot(d.rate);
    if (pair.level == ConstraintLevel::acceleration)
      out.C = n.dot(d.acceleration) + (d.rate - n.dot(d.rate) * n).squaredNorm() / length;
    out.gradient << -n, Vector3d::Zero(), n, Vector3d::Zero();
    return out;
  }
};

struct Curve {
  const SeenPair& pair;
  double lambda;
  Matrix12& Y;

  void operator()(const PointCoincidence&) const {}
  void operator()(const Along& row) const {
    const Vector3d d = pair.second.p - pair.first.p;
    const Matrix3d a = lambda * skew(pair.first.D.col(row.axis));
    Y.block<3, 3>(0, 3) += a, Y.block<3, 3>(6, 3) -= a;
    Y.block<3, 3>(3, 0) -= a, Y.block<3, 3>(3, 6) += a;
    Y.block<3, 3>(3, 3) += skew(d) * a;
  }
  void operator()(const Product& row) const {
    const Matrix3d a = skew(pair.first.D.col(row.i)), b = lambda * skew(pair.rotated.col(row.j));
    const Matrix3d ab = a * b, ba = b * a;
    Y.block<3, 3>(3, 3) += ba, Y.block<3, 3>(3, 9) -= ab;
    Y.block<3, 3>(9, 3) -= ba, Y.block<3, 3>(9, 9) += ab;
  }
  void operator()(const Separation&) const {
    const Vector3d d = pair.second.p - pair.first.p;
    const double length = distance(d);
    const Vector3d n = d / length;
    const Matrix3d across = lambda / length * (Matrix3d::Identity() - n * n.transpose());
    Y.block<3, 3>(0, 0) += across, Y.block<3, 3>(0, 6) -= across;
    Y.block<3, 3>(6, 0) -= across, Y.block<3, 3>(6, 6) += across;
  }
};

}  // namespace

SeenPair::SeenPair(const SpatialPair& pair, const TimeFunction& angle, const Motion& motion)
    : first(pair.pose[0]),
      second(pair.pose[1]),
      level(motion.level),
      t(motion.t),
      rotated(second.D),
      rotated_spin(second.spin),
      rotated_spin_rate(second.spin_rate) {
  if (!angle.value) return;
  const Vector3d z = second.D.col(2);
  rotated = second.D * Eigen::AngleAxisd(-angle.value(t), Vector3d::UnitZ()).toRotationMatrix();
  if (level == ConstraintLevel::position) return;
  const double rate = angle.rate(t);
  rotated_spin -= rate * z;
  if (level == ConstraintLevel::velocity) return;
  rotated_spin_rate -= angle.acceleration(t) * z + rate * second.spin.cross(z);
}

RowValue evaluate(const SpatialRow& row, const SeenPair& pair) { return std::visit(Evaluate{pair}, row); }

void add_curvature(const SpatialRow& row, const SeenPair& pair, double lambda, Matrix12& Y) {
  std::visit(Curve{pair, lambda, Y}, row);
}

}  // namespace floe::dynamics
