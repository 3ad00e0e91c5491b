#include "floe/body/floating_frame.h"

#include <cmath>

namespace floe::body {
namespace {

using Eigen::Vector2d;

Vector2d rotated_quarter(const Vector2d& x) { return {-x.y(), x.x()}; }  // J x

Eigen::Matrix2d rotation(double theta) {
  const double c = std::cos(theta), s = std::sin(theta);
  return (Eigen::Matrix2d() << c, -s, s, c).finished();
}

}  // namespace

void add_inertia_force(const PlanarInertia& in, const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                       const Eigen::VectorXd& a, Eigen::VectorXd& r) {
  const Eigen::Index k = in.M.rows();
  const auto e = q.tail(k), ed = v.tail(k), edd = a.tail(k);
  const double w = v[2], wd = a[2];
  const Eigen::Matrix2d A = rotation(q[2]);
  const Vector2d sigma = in.s0 + in.S * e, sigma_d = in.S * ed, sigma_dd = in.S * edd;
  const Vector2d Rdd = A.transpose() * a.head<2>();  // in body axes

  const Vector2d momentum_rate =
      in.m * Rdd + rotated_quarter(sigma) * wd + sigma_dd - w * w * sigma + 2 * w * rotated_quarter(sigma_d);
  r.head<2>() += A * momentum_rate;

  const Eigen::VectorXd Me = in.M * e, Be = in.B * e;  // B' e = -B e
  const double moment = in.C0 + 2 * in.h.dot(e) + e.dot(Me);
  r[2] += rotated_quarter(sigma).dot(Rdd) + moment * wd + (in.g - Be).dot(edd) + 2 * w * (in.h + Me).dot(ed);

  auto elastic = r.tail(k);
  elastic.noalias() += in.S.transpose() * Rdd;
  elastic += (in.g - Be) * wd - w * w * (in.h + Me);
  elastic.noalias() += in.M * edd;
  elastic.noalias() -= 2 * w * (in.B * ed);
}

void add_inertia_tangent(const PlanarInertia& in, const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                         const Eigen::VectorXd& a, double wq, double wv, double wa, Eigen::MatrixXd& J) {
  const Eigen::Index k = in.M.rows();
  const auto e = q.tail(k), ed = v.tail(k), edd = a.tail(k);
  const double w = v[2], wd = a[2];
  const Eigen::Matrix2d A = rotation(q[2]);
  const Eigen::Matrix2d quarter = (Eigen::Matrix2d() << 0, -1, 1, 0).finished();
  const Vector2d sigma = in.s0 + in.S * e, sigma_d = in.S * ed, sigma_dd = in.S * edd;
  const Vector2d Jsigma = rotated_quarter(sigma);
  const Vector2d Rdd = A.transpose() * a.head<2>();
  const Eigen::VectorXd Me = in.M * e, Be = in.B * e, Med = in.M * ed;
  const Eigen::VectorXd hMe = in.h + Me, gBe = in.g - Be;

  // rows of R
  J.block<2, 2>(0, 0) += wa * in.m * Eigen::Matrix2d::Identity();
  const Vector2d relative = Jsigma * wd + sigma_dd - w * w * sigma + 2 * w * rotated_quarter(sigma_d);
  J.block<2, 1>(0, 2) +=
      A * (wq * rotated_quarter(relative) + wv * (2 * rotated_quarter(sigma_d) - 2 * w * sigma) + wa * Jsigma);
  const Eigen::Matrix2d onS = A * ((wa - wq * w * w) * Eigen::Matrix2d::Identity() + (wq * wd + wv * 2 * w) * quarter);
  J.block(0, 3, 2, k).noalias() += onS * in.S;

  // row of theta
  const double moment = in.C0 + 2 * in.h.dot(e) + e.dot(Me);
  J.block<1, 2>(2, 0) += wa * (A * Jsigma).transpose();
  J(2, 2) += -wq * sigma.dot(Rdd) + wv * 2 * hMe.dot(ed) + wa * moment;
  auto theta_row = J.block(2, 3, 1, k);
  theta_row.noalias() += wq * (-rotated_quarter(Rdd).transpose()) * in.S;  // (J S)' R = -S' J R
  theta_row += (wq * (2 * wd * hMe + 2 * w * Med) + wv * 2 * w * hMe + wa * gBe).transpose();
  theta_row.noalias() += wq * (in.B * edd).transpose();

  // rows of q
  J.block(3, 0, k, 2).noalias() += wa * in.S.transpose() * A.transpose();
  auto theta_column = J.block(3, 2, k, 1);
  theta_column.noalias() -= wq * in.S.transpose() * rotated_quarter(Rdd);
  theta_column += -wv * 2 * w * hMe + wa * gBe;
  theta_column.noalias() -= wv * 2 * (in.B * ed);
  auto elastic = J.block(3, 3, k, k);
  elastic += (wa - wq * w * w) * in.M - (wq * wd + wv * 2 * w) * in.B;
}

double kinetic_energy(const PlanarInertia& in, const Eigen::VectorXd& q, const Eigen::VectorXd& v) {
  const Eigen::Index k = in.M.rows();
  const auto e = q.tail(k), ed = v.tail(k);
  const double w = v[2];
  const Vector2d Rd = rotation(q[2]).transpose() * v.head<2>();
  const Vector2d sigma = in.s0 + in.S * e;
  const Eigen::VectorXd Me = in.M * e;
  const double moment = in.C0 + 2 * in.h.dot(e) + e.dot(Me);
  return 0.5 * (in.m * Rd.squaredNorm() + moment * w * w + ed.dot(in.M * ed)) +
         Rd.dot(rotated_quarter(sigma) * w + in.S * ed) + w * (in.g - in.B * e).dot(ed);
}

}  // namespace floe::body
