#include "floe/dynamics/spatial_marker.h"

namespace floe::dynamics {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using math::rotation_tangent_derivative;
using math::skew;

/// Displacement and rotation of the place by the elastic coordinates, or rates of both by theirs.
struct Elastic {
  Vector3d u = Vector3d::Zero(), rotation = Vector3d::Zero();
};

Elastic elastic(const SpatialMarker& marker, const Eigen::Matrix3Xd& S, const Eigen::VectorXd& x) {
  Elastic e;
  const Index frame = marker.framed() ? 6 : 0;
  for (Index j = 0; j < S.cols(); ++j) {
    e.u += x[frame + j] * S.col(j);
    e.rotation += x[frame + j] * marker.psi.col(j);
  }
  return e;
}

/// H b, by rows: of half its product with b the derivative by b.
Matrix3d change(const SpatialMarker& marker, const Vector3d& b) {
  Matrix3d rows;
  for (std::size_t a = 0; a < 3; ++a) rows.row(static_cast<Index>(a)) = b.transpose() * marker.H[a];
  return rows;
}

/// w . H.
Matrix3d form(const SpatialMarker& marker, const Vector3d& w) {
  return w[0] * marker.H[0] + w[1] * marker.H[1] + w[2] * marker.H[2];
}

bool has_arm(const SpatialMarker& marker) { return !marker.arm.isZero(0); }

/// S(e).
const Eigen::Matrix3Xd& directions(const SpatialMarker& marker, const SpatialPose& at) {
  return marker.Q.empty() && !has_arm(marker) ? marker.S : at.S;
}

/// What an arm that rotates by beta has beyond its first order, b x arm. After D and bend.
void see_arm(const SpatialMarker& marker, const Matrix3d& rotation, const Vector3d& b, SpatialPose& out) {
  if (!has_arm(marker)) return;
  out.arm = rotation * marker.arm;
  out.c += out.arm - marker.arm - b.cross(marker.arm);
  const Matrix3d change = skew(marker.arm) - skew(out.arm) * out.bend.transpose();
  if (marker.Q.empty()) out.S = marker.S;
  out.S.noalias() += change * marker.psi;
}

void fill_directions(const SpatialMarker& marker, SpatialPose& out) {
  const Index k = marker.S.cols(), frame = marker.framed() ? 6 : 0;
  out.P.resize(6, frame + k);
  if (marker.framed()) {
    out.P.leftCols<3>() << marker.mass * Matrix3d::Identity(), Matrix3d::Zero();
    out.P.middleCols<3>(3) << -out.A * skew(out.c), out.A;
  }
  const Matrix3d rotated = out.A * out.bend.transpose();
  for (Index j = 0; j < k; ++j) {
    const Vector3d shift = directions(marker, out).col(j), rotation = marker.psi.col(j);
    out.P.col(frame + j) << out.A * shift, rotated * rotation;
  }
}

void see_place(const SpatialMarker& marker, const Eigen::VectorXd& q, SpatialPose& out) {
  Vector3d R = marker.origin;
  if (marker.framed()) {
    const Vector3d x = q.segment<3>(3);
    R = q.head<3>(), out.A = marker.attitude->axes(x), out.T = math::rotation_tangent(x);
  } else {
    out.A = marker.axes, out.T = Matrix3d::Identity();
  }
  const Elastic e = elastic(marker, marker.S, q);
  out.c = marker.x0 + e.u, out.beta = e.rotation, out.G = Matrix3d::Identity();
  if (!marker.Q.empty()) {
    const Eigen::VectorXd own = q.segment(marker.framed() ? 6 : 0, marker.S.cols());
    marker.Q.multiply(own, out.S);
    out.c += 0.5 * out.S * own;
    out.S += marker.S;
  }
  Matrix3d rotation = Matrix3d::Identity();
  out.bend = Matrix3d::Identity();
  if (!e.rotation.isZero(0)) {
    if (!marker.H.empty()) {
      const Matrix3d H = change(marker, e.rotation);
      out.beta += 0.5 * H * e.rotation, out.G = Matrix3d::Identity() + H;
    }
    rotation = math::rotation(out.beta);
    out.bend = math::rotation_tangent(out.beta);
    if (!marker.H.empty()) out.bend = (out.G.transpose() * out.bend).eval();
  }
  see_arm(marker, rotation, e.rotation, out);
  out.p = marker.mass * R + out.A * out.c;
  out.D = out.A * rotation * marker.D0;
}

/// After see_place.
void see_motion(const SpatialMarker& marker, const Eigen::VectorXd& v, const Eigen::VectorXd& a, SpatialPose& out) {
  Vector3d Rd = Vector3d::Zero(), Rdd = Vector3d::Zero(), alpha = Vector3d::Zero(), w = Vector3d::Zero();
  if (marker.framed()) Rd = v.head<3>(), Rdd = a.head<3>(), w = v.segment<3>(3), alpha = a.segment<3>(3);
  const Elastic ed = elastic(marker, directions(marker, out), v);
  Elastic edd = elastic(marker, directions(marker, out), a);
  if (!marker.Q.empty()) {
    const Eigen::VectorXd own = v.segment(marker.framed() ? 6 : 0, marker.S.cols());
    marker.Q.multiply(own, out.Qed);
    edd.u += out.Qed * own;
  }
  out.omega = w, out.beta_rate = ed.rotation;
  out.c_rate = w.cross(out.c) + ed.u;
  out.velocity = marker.mass * Rd + out.A * out.c_rate;
  const Vector3d bending = out.bend.transpose() * ed.rotation;
  out.rotation = w + bending;
  out.spin = out.A * out.rotation;
  Vector3d centrifugal = Vector3d::Zero();  // of the bending's rate, what b.. does not contain
  if (!marker.H.empty()) {
    out.beta_rate = out.G * ed.rotation, out.H_rate = change(marker, ed.rotation);
    centrifugal += math::rotation_tangent(-out.beta) * (out.H_rate * ed.rotation);
  }
  // T' = T(-beta): d(T(-beta) b)/dbeta = -d(T(x) b)/dx at x = -beta
  centrifugal -= rotation_tangent_derivative(-out.beta, out.beta_rate) * out.beta_rate;
  if (has_arm(marker)) edd.u += centrifugal.cross(out.arm) + bending.cross(bending.cross(out.arm));
  out.acceleration = marker.mass * Rdd + out.A * (alpha.cross(out.c) + w.cross(out.c_rate) + w.cross(ed.u) + edd.u);
  out.spin_rate = out.A * (alpha + w.cross(bending) + out.bend.transpose() * edd.rotation + centrifugal);
}

}  // namespace

SpatialMarker SpatialMarker::ground(const Vector3d& point, const Matrix3d& axes) {
  SpatialMarker marker;
  marker.x0 = point;
  marker.D0 = axes;
  return marker;
}

void pose(const SpatialMarker& marker, const Eigen::VectorXd& q, const Eigen::VectorXd& v, const Eigen::VectorXd& a,
          SpatialPose& out, EvaluationLevel level) {
  see_place(marker, q, out);
  if (level != EvaluationLevel::position) fill_directions(marker, out);
  if (level == EvaluationLevel::velocity) see_motion(marker, v, a, out);
}

void pull_back(const SpatialMarker& marker, const SpatialPose& at, const Wrench& wrench, Eigen::VectorXd& rows) {
  const Index k = marker.S.cols(), frame = marker.framed() ? 6 : 0;
  rows.resize(frame + k);
  const Vector3d force = at.A.transpose() * wrench.head<3>(), moment = at.A.transpose() * wrench.tail<3>();
  if (marker.framed()) rows.head<3>() = marker.mass * wrench.head<3>(), rows.segment<3>(3) = at.c.cross(force) + moment;
  const Eigen::Matrix3Xd& S = directions(marker, at);
  for (Index j = 0; j < k; ++j) rows[frame + j] = S.col(j).dot(force);
  if (k == 0 || moment.isZero(0)) return;
  const Vector3d bending = at.bend * moment;
  for (Index j = 0; j < k; ++j) rows[frame + j] += marker.psi.col(j).dot(bending);
}

void rate_gradient(const SpatialMarker& marker, const SpatialPose& at, Matrix6Xd& out) {
  const Index k = marker.S.cols(), frame = marker.framed() ? 6 : 0;
  out.resize(6, frame + k);
  if (marker.framed()) {
    out.leftCols<3>().setZero();
    out.middleCols<3>(3) << -at.A * skew(at.c_rate), -at.A * skew(at.rotation);
  }
  const Matrix3d dragged = at.A * skew(at.omega);
  Matrix3d bent = -at.A * rotation_tangent_derivative(-at.beta, at.beta_rate);
  if (!marker.H.empty()) bent = (bent * at.G + at.A * math::rotation_tangent(-at.beta) * at.H_rate).eval();
  out.topRightCorner(3, k).noalias() = dragged * directions(marker, at);
  if (!marker.Q.empty()) out.topRightCorner(3, k).noalias() += at.A * at.Qed;
  if (has_arm(marker)) {
    const Matrix3d bending = skew(at.rotation - at.omega), arm = skew(at.arm);
    const Matrix3d moved = -at.A * (arm * at.A.transpose() * bent + bending * arm * at.bend.transpose());
    out.topRightCorner(3, k).noalias() += moved * marker.psi;
  }
  out.bottomRightCorner(3, k).noalias() = bent * marker.psi;
}

void add_geometric_stiffness(const SpatialMarker& marker, const SpatialPose& at, const Wrench& wrench, double weight,
                             Eigen::MatrixXd& K) {
  const Index k = marker.S.cols(), frame = marker.framed() ? 6 : 0;
  const Matrix3d f = weight * skew(at.A.transpose() * wrench.head<3>());
  Vector3d moment = weight * (at.A.transpose() * wrench.tail<3>());
  if (marker.framed()) {
    const Matrix3d m = skew(moment), of_x = at.bend * m * at.T, force_of_x = f * at.T;
    K.block<3, 3>(3, 3) += (skew(at.c) * f + m) * at.T;
    for (Index j = 0; j < k; ++j) {
      const Vector3d shift = directions(marker, at).col(j), rotation = marker.psi.col(j);
      K.block<3, 1>(3, 6 + j) -= f * shift;
      K.block<1, 3>(6 + j, 3) += shift.transpose() * force_of_x + rotation.transpose() * of_x;
    }
  }
  if (!marker.Q.empty()) {
    const Vector3d force = weight * (at.A.transpose() * wrench.head<3>());
    for (int a = 0; a < 3; ++a) K.block(frame, frame, k, k) += force[a] * marker.Q[a];
  }
  if (has_arm(marker)) moment += at.arm.cross(weight * (at.A.transpose() * wrench.head<3>()));
  if (k == 0 || (moment.isZero(0) && !has_arm(marker))) return;
  Matrix3d bent = rotation_tangent_derivative(at.beta, moment);
  if (!marker.H.empty())
    bent = (at.G.transpose() * bent * at.G + form(marker, math::rotation_tangent(at.beta) * moment)).eval();
  if (has_arm(marker)) bent += at.bend * f * skew(at.arm) * at.bend.transpose();
  for (Index j = 0; j < k; ++j) {
    const Vector3d rotated = bent * marker.psi.col(j);
    K.col(frame + j).segment(frame, k) += marker.psi.transpose().lazyProduct(rotated);
  }
}

}  // namespace floe::dynamics
