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

namespace {

/// Displacement of the place in its own axes, (x + S q, psi q), and its rates; summed in one pass over the columns.
struct Elastic {
  Eigen::Vector2d u, ud = Eigen::Vector2d::Zero(), udd = Eigen::Vector2d::Zero();
  double turn = 0, turn_d = 0, turn_dd = 0;
};

Elastic elastic(const Marker& marker, Eigen::Index frame, const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                const Eigen::VectorXd& a) {
  Elastic e;
  e.u = marker.x;
  for (Eigen::Index j = 0; j < marker.S.cols(); ++j) {
    const double qj = q[frame + j], vj = v[frame + j], aj = a[frame + j], psi = marker.psi[j];
    const Eigen::Vector2d column = marker.S.col(j);
    e.u += qj * column, e.ud += vj * column, e.udd += aj * column;
    e.turn += qj * psi, e.turn_d += vj * psi, e.turn_dd += aj * psi;
  }
  return e;
}

}  // namespace

void pose(const Marker& marker, const Eigen::VectorXd& q, const Eigen::VectorXd& v, const Eigen::VectorXd& a,
          Pose& out) {
  const Eigen::Index k = marker.S.cols();
  const Eigen::Index frame = marker.framed ? 3 : 0;
  out.P.resize(3, frame + k);
  out.dyd.resize(3, frame + k);
  const auto [u, ud, udd, turn, turn_d, turn_dd] = elastic(marker, frame, q, v, a);
  if (!marker.framed) {
    out.arm = u;
    out.y << u, marker.angle0 + turn;
    out.yd << ud, turn_d;
    out.ydd << udd, turn_dd;
    out.P.topRows<2>() = marker.S;
    out.P.row(2) = marker.psi;
    out.dyd.setZero();
    return;
  }
  const double c = std::cos(q[2]), s = std::sin(q[2]), w = v[2], wd = a[2];
  const Eigen::Matrix2d A = (Eigen::Matrix2d() << c, -s, s, c).finished();
  const Eigen::Matrix2d AJ = (Eigen::Matrix2d() << -s, -c, c, -s).finished();
  out.arm = A * u;
  const Eigen::Vector2d across = AJ * u, across_d = AJ * ud;
  out.y << marker.mass * q.head<2>() + out.arm, marker.angle0 + q[2] + turn;
  out.yd << marker.mass * v.head<2>() + across * w + A * ud, w + turn_d;
  out.ydd << marker.mass * a.head<2>() + across * wd + A * udd - w * w * out.arm + 2 * w * across_d, wd + turn_dd;
  out.P.leftCols<3>() << marker.mass, 0, across.x(), 0, marker.mass, across.y(), 0, 0, 1;
  out.dyd.leftCols<3>().setZero();
  out.dyd.col(2).head<2>() = -w * out.arm + across_d;
  for (Eigen::Index j = 0; j < k; ++j) {
    const Eigen::Vector2d turned = A * marker.S.col(j);
    out.P.col(3 + j) << turned, marker.psi[j];
    out.dyd.col(3 + j) << -w * turned.y(), w * turned.x(), 0;  // A J S = J A S
  }
}

double geometric_stiffness(const Pose& at, const Eigen::Vector3d& wrench, Eigen::Index i) {
  if (i < 2) return 0;
  if (i == 2) return -at.arm.dot(wrench.head<2>());
  // A S q is turned by theta: d(A S)/dtheta = J A S, and P holds A S
  return wrench.y() * at.P(0, i) - wrench.x() * at.P(1, i);
}

void add_geometric_stiffness(const Marker& marker, const Pose& at, const Eigen::Vector3d& wrench, double weight,
                             Eigen::Ref<Eigen::MatrixXd> K) {
  if (!marker.framed) return;
  for (Eigen::Index i = 2; i < at.P.cols(); ++i) {
    const double entry = weight * geometric_stiffness(at, wrench, i);
    K(2, i) += entry;
    if (i != 2) K(i, 2) += entry;
  }
}

}  // namespace floe::dynamics
