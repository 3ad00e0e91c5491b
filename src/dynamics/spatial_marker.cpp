#include "floe/dynamics/spatial_marker.h"

namespace floe::dynamics {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using math::rotation_tangent_derivative;
using math::skew;

/// Displacement and turning of the place by the elastic coordinates and their rates; one pass over the columns.
struct Elastic {
  Vector3d u, ud = Vector3d::Zero(), udd = Vector3d::Zero();
  Vector3d turn = Vector3d::Zero(), turn_d = Vector3d::Zero(), turn_dd = Vector3d::Zero();
};

Elastic elastic(const SpatialMarker& marker, Index frame, const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                const Eigen::VectorXd& a) {
  Elastic e;
  e.u = marker.x0;
  for (Index j = 0; j < marker.S.cols(); ++j) {
    const double qj = q[frame + j], vj = v[frame + j], aj = a[frame + j];
    const Vector3d shift = marker.S.col(j), turn = marker.psi.col(j);
    e.u += qj * shift, e.ud += vj * shift, e.udd += aj * shift;
    e.turn += qj * turn, e.turn_d += vj * turn, e.turn_dd += aj * turn;
  }
  return e;
}

/// The frame's motion: position and rates of its origin; the rest goes into the pose.
struct Origin {
  Vector3d R, Rd = Vector3d::Zero(), Rdd = Vector3d::Zero(), alpha = Vector3d::Zero();
};

Origin place_frame(const SpatialMarker& marker, const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                   const Eigen::VectorXd& a, SpatialPose& out) {
  if (!marker.framed()) {
    out.A = marker.axes, out.T = Matrix3d::Identity(), out.omega.setZero();
    return {marker.origin};
  }
  const Vector3d x = q.segment<3>(3);
  out.A = marker.attitude->axes(x), out.T = math::rotation_tangent(x), out.omega = v.segment<3>(3);
  return {q.head<3>(), v.head<3>(), a.head<3>(), a.segment<3>(3)};
}

void fill_directions(const SpatialMarker& marker, SpatialPose& out) {
  const Index k = marker.S.cols(), frame = marker.framed() ? 6 : 0;
  out.P.resize(6, frame + k);
  if (marker.framed()) {
    out.P.leftCols<3>() << marker.mass * Matrix3d::Identity(), Matrix3d::Zero();
    out.P.middleCols<3>(3) << -out.A * skew(out.c), out.A;
  }
  const Matrix3d turned = out.A * out.bend.transpose();
  out.P.topRightCorner(3, k).noalias() = out.A * marker.S;
  out.P.bottomRightCorner(3, k).noalias() = turned * marker.psi;
}

}  // namespace

SpatialMarker SpatialMarker::ground(const Vector3d& point, const Matrix3d& axes) {
  SpatialMarker marker;
  marker.x0 = point;
  marker.D0 = axes;
  return marker;
}

void pose(const SpatialMarker& marker, const Eigen::VectorXd& q, const Eigen::VectorXd& v, const Eigen::VectorXd& a,
          SpatialPose& out) {
  const Origin at = place_frame(marker, q, v, a, out);
  const Elastic e = elastic(marker, marker.framed() ? 6 : 0, q, v, a);
  const Vector3d& w = out.omega;
  out.c = e.u, out.beta = e.turn, out.beta_rate = e.turn_d;
  out.bend = math::rotation_tangent(e.turn);
  out.c_rate = w.cross(e.u) + e.ud;
  out.p = marker.mass * at.R + out.A * out.c;
  out.velocity = marker.mass * at.Rd + out.A * out.c_rate;
  out.acceleration = marker.mass * at.Rdd + out.A * (at.alpha.cross(e.u) + w.cross(out.c_rate) + w.cross(e.ud) + e.udd);
  const Vector3d bending = out.bend.transpose() * e.turn_d;
  out.turn = w + bending;
  out.D = out.A * math::rotation(e.turn) * marker.D0;
  out.spin = out.A * out.turn;
  // T' = T(-beta): d(T(-beta) b)/dbeta = -d(T(x) b)/dx at x = -beta
  out.spin_rate = out.A * (at.alpha + w.cross(bending) + out.bend.transpose() * e.turn_dd -
                           rotation_tangent_derivative(-e.turn, e.turn_d) * e.turn_d);
  fill_directions(marker, out);
}

void rate_gradient(const SpatialMarker& marker, const SpatialPose& at, Matrix6Xd& out) {
  const Index k = marker.S.cols(), frame = marker.framed() ? 6 : 0;
  out.resize(6, frame + k);
  if (marker.framed()) {
    out.leftCols<3>().setZero();
    out.middleCols<3>(3) << -at.A * skew(at.c_rate), -at.A * skew(at.turn);
  }
  const Matrix3d dragged = at.A * skew(at.omega), bent = -at.A * rotation_tangent_derivative(-at.beta, at.beta_rate);
  out.topRightCorner(3, k).noalias() = dragged * marker.S;
  out.bottomRightCorner(3, k).noalias() = bent * marker.psi;
}

void add_geometric_stiffness(const SpatialMarker& marker, const SpatialPose& at, const Wrench& wrench, double weight,
                             Eigen::MatrixXd& K) {
  const Index k = marker.S.cols(), frame = marker.framed() ? 6 : 0;
  const Matrix3d f = weight * skew(at.A.transpose() * wrench.head<3>());
  const Vector3d moment = weight * (at.A.transpose() * wrench.tail<3>());
  if (marker.framed()) {
    const Matrix3d m = skew(moment), of_x = at.bend * m * at.T, force_of_x = f * at.T;
    K.block<3, 3>(3, 3) += (skew(at.c) * f + m) * at.T;
    for (Index j = 0; j < k; ++j) {
      const Vector3d shift = marker.S.col(j), turn = marker.psi.col(j);
      K.block<3, 1>(3, 6 + j) -= f * shift;
      K.block<1, 3>(6 + j, 3) += shift.transpose() * force_of_x + turn.transpose() * of_x;
    }
  }
  if (k == 0 || moment.isZero(0)) return;
  const Matrix3d bent = rotation_tangent_derivative(at.beta, moment);
  for (Index j = 0; j < k; ++j) {
    const Vector3d turned = bent * marker.psi.col(j);
    K.col(frame + j).tail(k) += marker.psi.transpose().lazyProduct(turned);
  }
}

}  // namespace floe::dynamics
