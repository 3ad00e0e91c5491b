#include "floe/dynamics/marker.h"

#include <Eigen/Geometry>
#include <cmath>

#include "floe/math/matrix_vector.h"

namespace floe::dynamics {

Marker Marker::ground(Eigen::Vector2d point, double angle) {
  Marker marker;
  marker.x = point;
  marker.angle0 = angle;
  marker.S.resize(2, 0);
  marker.psi.resize(0);
  return marker;
}

namespace {

using Eigen::Index;
using Eigen::Vector2d;

/// A displacement and a rotation.
struct Rotated {
  Vector2d u = Vector2d::Zero();
  double rotation = 0;
};

/// (S x, psi x), x from entry `frame` on.
Rotated elastic(const Marker& marker, const Eigen::Matrix2Xd& S, const Eigen::VectorXd& x) {
  Rotated sum;
  const Index frame = marker.framed ? 3 : 0;
  for (Index j = 0; j < S.cols(); ++j) {
    sum.u += x[frame + j] * S.col(j);
    sum.rotation += x[frame + j] * marker.psi[j];
  }
  return sum;
}

/// Q(x, x), both from the frame's entries on.
Vector2d quadratic(const Marker& marker, const Eigen::VectorXd& x) {
  const Eigen::VectorXd e = x.segment(marker.framed ? 3 : 0, marker.S.cols());
  return {e.dot(marker.Q[0] * e), e.dot(marker.Q[1] * e)};
}

/// dp/dq in the frame's axes.
const Eigen::Matrix2Xd& directions(const Marker& marker, const Pose& out) {
  return marker.Q.empty() ? marker.S : out.S;
}

void see_place(const Marker& marker, const Eigen::VectorXd& q, Pose& out) {
  const Index k = marker.S.cols();
  Rotated e = elastic(marker, marker.S, q);
  if (!marker.Q.empty()) {
    e.u += 0.5 * quadratic(marker, q);
    math::multiply_forms(marker.Q, q.segment(marker.framed ? 3 : 0, k), out.S);
    out.S += marker.S;
  }
  const Eigen::Matrix2Xd& S_of_q = directions(marker, out);
  out.angle = marker.framed ? q[2] : 0;
  if (!marker.framed) {
    out.arm = marker.x + e.u;
    out.y << out.arm, marker.angle0 + e.rotation;
    out.P.resize(3, k);
    out.P.topRows<2>() = S_of_q;
    out.P.row(2) = marker.psi;
    return;
  }
  const double c = std::cos(q[2]), s = std::sin(q[2]);
  const Vector2d u = marker.x + e.u;
  out.arm = Vector2d(c * u.x() - s * u.y(), s * u.x() + c * u.y());
  out.y << marker.mass * q.head<2>() + out.arm, marker.angle0 + q[2] + e.rotation;
  out.P.resize(3, 3 + k);
  out.P.leftCols<3>() << marker.mass, 0, -out.arm.y(), 0, marker.mass, out.arm.x(), 0, 0, 1;
  const double *S = S_of_q.data(), *psi = marker.psi.data();
  double* P = out.P.data() + 9;
  for (Index j = 0; j < k; ++j, S += 2, P += 3) {
    P[0] = c * S[0] - s * S[1];
    P[1] = s * S[0] + c * S[1];
    P[2] = psi[j];
  }
}

/// A Q v.
void add_rate_of_directions(const Marker& marker, const Eigen::VectorXd& v, double angle, Eigen::Matrix3Xd& dyd) {
  Eigen::Matrix2Xd rates;
  math::multiply_forms(marker.Q, v.segment(marker.framed ? 3 : 0, marker.S.cols()), rates);
  dyd.topRightCorner(2, rates.cols()) += Eigen::Rotation2Dd(angle).toRotationMatrix() * rates;
}

/// After see_place.
void see_motion(const Marker& marker, const Eigen::VectorXd& q, const Eigen::VectorXd& v, const Eigen::VectorXd& a,
                Pose& out) {
  const Index k = marker.S.cols(), frame = marker.framed ? 3 : 0;
  const auto [ud, rotation_d] = elastic(marker, directions(marker, out), v);
  auto [udd, rotation_dd] = elastic(marker, directions(marker, out), a);
  if (!marker.Q.empty()) udd += quadratic(marker, v);
  out.dyd.resize(3, frame + k);
  if (!marker.framed) {
    out.yd << ud, rotation_d;
    out.ydd << udd, rotation_dd;
    out.dyd.setZero();
    if (!marker.Q.empty()) add_rate_of_directions(marker, v, out.angle, out.dyd);
    return;
  }
  const double c = std::cos(q[2]), s = std::sin(q[2]), w = v[2], wd = a[2];
  const Eigen::Matrix2d A = (Eigen::Matrix2d() << c, -s, s, c).finished();
  const Eigen::Matrix2d AJ = (Eigen::Matrix2d() << -s, -c, c, -s).finished();
  const Vector2d across(-out.arm.y(), out.arm.x()), across_d = AJ * ud;
  out.yd << marker.mass * v.head<2>() + across * w + A * ud, w + rotation_d;
  out.ydd << marker.mass * a.head<2>() + across * wd + A * udd - w * w * out.arm + 2 * w * across_d, wd + rotation_dd;
  out.dyd.leftCols<3>().setZero();
  out.dyd.col(2).head<2>() = -w * out.arm + across_d;
  for (Index j = 3; j < 3 + k; ++j) out.dyd.col(j) << -w * out.P(1, j), w * out.P(0, j), 0;  // A J S = J A S
  if (!marker.Q.empty()) add_rate_of_directions(marker, v, out.angle, out.dyd);
}

}  // namespace

void pose(const Marker& marker, const Eigen::VectorXd& q, const Eigen::VectorXd& v, const Eigen::VectorXd& a, Pose& out,
          EvaluationLevel level) {
  see_place(marker, q, out);
  if (level == EvaluationLevel::velocity) see_motion(marker, q, v, a, out);
}

double geometric_stiffness(const Pose& at, const Eigen::Vector3d& wrench, Eigen::Index i) {
  if (i < 2) return 0;
  if (i == 2) return -at.arm.dot(wrench.head<2>());
  // A S q is rotated by theta: d(A S)/dtheta = J A S, and P holds A S
  return wrench.y() * at.P(0, i) - wrench.x() * at.P(1, i);
}

void add_geometric_stiffness(const Marker& marker, const Pose& at, const Eigen::Vector3d& wrench, double weight,
                             Eigen::Ref<Eigen::MatrixXd> K) {
  for (Eigen::Index i = 2; marker.framed && i < at.P.cols(); ++i) {
    const double entry = weight * geometric_stiffness(at, wrench, i);
    K(2, i) += entry;
    if (i != 2) K(i, 2) += entry;
  }
  if (marker.Q.empty()) return;
  const Eigen::Index k = marker.S.cols(), frame = marker.framed ? 3 : 0;
  const Vector2d force = Eigen::Rotation2Dd(-at.angle) * Vector2d(wrench.head<2>());
  K.block(frame, frame, k, k) += weight * (force[0] * marker.Q[0] + force[1] * marker.Q[1]);
}

}  // namespace floe::dynamics
