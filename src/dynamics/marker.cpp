#include "floe/dynamics/marker.h"

#include <cmath>

namespace floe::dynamics {

Marker Marker::ground(Eigen::Vector2d point, double angle) {
  Marker marker;
  marker.x = point;
  marker.angle0 = angle;
  marker.S.resize(2, 0);
  marker.psi.resize(0);
  return marker;
}

void pose(const Marker& marker, const Eigen::VectorXd& q, const Eigen::VectorXd& v, const Eigen::VectorXd& a,
          Pose& out) {
  const Eigen::Index k = marker.S.cols();
  const Eigen::Index frame = marker.framed ? 3 : 0;
  out.P.setZero(3, frame + k);
  out.dyd.setZero(3, frame + k);
  const auto e = q.tail(k), ed = v.tail(k), edd = a.tail(k);
  const Eigen::Vector2d u = marker.x + marker.S * e, ud = marker.S * ed, udd = marker.S * edd;
  const double turn = marker.psi.dot(e), turn_d = marker.psi.dot(ed), turn_dd = marker.psi.dot(edd);
  if (!marker.framed) {
    out.arm = u;
    out.y << u, marker.angle0 + turn;
    out.yd << ud, turn_d;
    out.ydd << udd, turn_dd;
    out.P.topRows<2>() = marker.S;
    out.P.row(2) = marker.psi;
    return;
  }
  const double c = std::cos(q[2]), s = std::sin(q[2]), w = v[2], wd = a[2];
  const Eigen::Matrix2d A = (Eigen::Matrix2d() << c, -s, s, c).finished();
  const Eigen::Matrix2d AJ = (Eigen::Matrix2d() << -s, -c, c, -s).finished();
  out.arm = A * u;
  const Eigen::Vector2d across = AJ * u;
  out.y << marker.mass * q.head<2>() + out.arm, marker.angle0 + q[2] + turn;
  out.yd << marker.mass * v.head<2>() + across * w + A * ud, w + turn_d;
  out.ydd << marker.mass * a.head<2>() + across * wd + A * udd - w * w * out.arm + 2 * w * (AJ * ud), wd + turn_dd;
  out.P.block<2, 2>(0, 0) = marker.mass * Eigen::Matrix2d::Identity();
  out.P.block<2, 1>(0, 2) = across;
  out.P.block(0, 3, 2, k).noalias() = A * marker.S;
  out.P(2, 2) = 1;
  out.P.block(2, 3, 1, k) = marker.psi;
  out.dyd.block<2, 1>(0, 2) = -w * out.arm + AJ * ud;
  out.dyd.block(0, 3, 2, k).noalias() = w * AJ * marker.S;
}

void add_geometric_stiffness(const Marker& marker, const Pose& at, const Eigen::Vector3d& wrench, double weight,
                             Eigen::Ref<Eigen::MatrixXd> K) {
  if (!marker.framed) return;
  const Eigen::Index k = marker.S.cols();
  const Eigen::Vector2d f = wrench.head<2>();
  K(2, 2) -= weight * at.arm.dot(f);
  // A S q is turned by theta: d(A S)/dtheta = J A S, and P holds A S
  const Eigen::Vector2d turned(f.y(), -f.x());  // J' f
  const Eigen::RowVectorXd mixed = weight * turned.transpose() * at.P.block(0, 3, 2, k);
  K.block(2, 3, 1, k) += mixed;
  K.block(3, 2, k, 1) += mixed.transpose();
}

}  // namespace floe::dynamics
