#include "floe/body/floating_frame.h"

#include <cmath>

#include "floe/math/matrix_vector.h"

namespace floe::body {
namespace {

using Eigen::Vector2d;

Vector2d rotated_quarter(const Vector2d& x) { return {-x.y(), x.x()}; }  // J x

Eigen::Matrix2d rotation(double theta) {
  const double c = std::cos(theta), s = std::sin(theta);
  return (Eigen::Matrix2d() << c, -s, s, c).finished();
}

/// S x, without the set-up of a general product.
template <class Vector>
Vector2d times(const Eigen::Matrix2Xd& S, const Vector& x) {
  Vector2d sum = Vector2d::Zero();
  for (Eigen::Index j = 0; j < S.cols(); ++j) sum += x[j] * S.col(j);
  return sum;
}

void products(const PlanarInertia& in, const Eigen::VectorXd& q, const Eigen::VectorXd& v, const Eigen::VectorXd& a,
              InertiaWork& work) {
  const Eigen::Index k = in.M.rows();
  work.e = q.tail(k), work.ed = v.tail(k), work.edd = a.tail(k);
  work.De.noalias() = in.D * work.e;
  work.Be.noalias() = in.B * work.e;  // B' e = -B e
  work.Bed.noalias() = in.B * work.ed;
  work.Yed.setZero(k);
  if (in.Q.empty()) return;
  work.Be.noalias() -= in.Y * work.e;
  work.Yed.noalias() = in.Y * work.ed;
  math::multiply_forms(in.Q, work.e, work.S);
  work.S += in.S;
  math::multiply_forms(in.Q, work.ed, work.Qed);
}

/// sigma and its rates in body axes.
struct FirstMoments {
  Vector2d sigma, sigma_d, sigma_dd;
};

const Eigen::Matrix2Xd& directions(const PlanarInertia& in, const InertiaWork& work) {
  return in.Q.empty() ? in.S : work.S;
}

FirstMoments first_moments(const PlanarInertia& in, const InertiaWork& work) {
  const Eigen::Matrix2Xd& S = directions(in, work);
  FirstMoments sum{in.s0 + times(S, work.e), times(S, work.ed), times(S, work.edd)};
  if (in.Q.empty()) return sum;
  sum.sigma += 0.5 * (times(in.S, work.e) - times(S, work.e));
  sum.sigma_dd += times(work.Qed, work.ed);
  return sum;
}

}  // namespace

void add_inertia_force(const PlanarInertia& in, const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                       const Eigen::VectorXd& a, InertiaWork& work, Eigen::VectorXd& r) {
  const Eigen::Index k = in.M.rows();
  products(in, q, v, a, work);
  const auto &e = work.e, &ed = work.ed, &edd = work.edd, &De = work.De, &Be = work.Be;
  const double w = v[2], wd = a[2];
  const Eigen::Matrix2d A = rotation(q[2]);
  const auto [sigma, sigma_d, sigma_dd] = first_moments(in, work);
  const Eigen::Matrix2Xd& S_of_e = directions(in, work);
  const Vector2d Rdd = A.transpose() * a.head<2>();  // in body axes

  const Vector2d momentum_rate =
      in.m * Rdd + rotated_quarter(sigma) * wd + sigma_dd - w * w * sigma + 2 * w * rotated_quarter(sigma_d);
  r.head<2>() += A * momentum_rate;

  const double moment = in.C0 + 2 * in.h.dot(e) + e.dot(De);
  r[2] += rotated_quarter(sigma).dot(Rdd) + moment * wd + in.g.dot(edd) - Be.dot(edd) + work.Yed.dot(ed) +
          2 * w * (in.h.dot(ed) + De.dot(ed));

  auto elastic = r.tail(k);
  elastic.noalias() += in.M * edd;
  for (Eigen::Index j = 0; j < k; ++j)
    elastic[j] += S_of_e.col(j).dot(Rdd) + (in.g[j] - Be[j]) * wd - w * w * (in.h[j] + De[j]) - 2 * w * work.Bed[j];
}

void add_inertia_tangent(const PlanarInertia& in, const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                         const Eigen::VectorXd& a, double wq, double wv, double wa, InertiaWork& work,
                         Eigen::MatrixXd& J) {
  const Eigen::Index k = in.M.rows();
  products(in, q, v, a, work);
  work.Ded.noalias() = in.D * work.ed;
  work.Bedd.noalias() = in.B * work.edd;
  if (!in.Q.empty()) work.Bedd.noalias() += in.Y * work.edd;
  const auto &e = work.e, &ed = work.ed, &edd = work.edd, &De = work.De, &Be = work.Be;
  const double w = v[2], wd = a[2];
  const Eigen::Matrix2d A = rotation(q[2]);
  const Eigen::Matrix2d quarter = (Eigen::Matrix2d() << 0, -1, 1, 0).finished();
  const auto [sigma, sigma_d, sigma_dd] = first_moments(in, work);
  const Eigen::Matrix2Xd& S_of_e = directions(in, work);
  const Vector2d Jsigma = rotated_quarter(sigma);
  const Vector2d Rdd = A.transpose() * a.head<2>(), rotated_Rdd = rotated_quarter(Rdd);

  // frame by frame
  const Vector2d relative = Jsigma * wd + sigma_dd - w * w * sigma + 2 * w * rotated_quarter(sigma_d);
  const double moment = in.C0 + 2 * in.h.dot(e) + e.dot(De);
  J.block<2, 2>(0, 0) += wa * in.m * Eigen::Matrix2d::Identity();
  J.block<2, 1>(0, 2) +=
      A * (wq * rotated_quarter(relative) + wv * (2 * rotated_quarter(sigma_d) - 2 * w * sigma) + wa * Jsigma);
  J.block<1, 2>(2, 0) += wa * (A * Jsigma).transpose();
  J(2, 2) += -wq * sigma.dot(Rdd) + wv * 2 * (in.h.dot(ed) + De.dot(ed)) + wa * moment;

  // frame by q and q by frame
  const Eigen::Matrix2d onS = A * ((wa - wq * w * w) * Eigen::Matrix2d::Identity() + (wq * wd + wv * 2 * w) * quarter);
  for (Eigen::Index j = 0; j < k; ++j) {
    const Vector2d S = S_of_e.col(j);
    const double hDe = in.h[j] + De[j], gBe = in.g[j] - Be[j], across = S.dot(rotated_Rdd);  // (J S)' R = -S' J R
    J.block<2, 1>(0, 3 + j) += onS * S;
    J.block<1, 2>(3 + j, 0) += wa * (A * S).transpose();
    J(2, 3 + j) +=
        wq * (work.Bedd[j] - across + 2 * wd * hDe + 2 * w * work.Ded[j]) + wv * 2 * (w * hDe + work.Yed[j]) + wa * gBe;
    J(3 + j, 2) += wa * gBe - wq * across - wv * 2 * (w * hDe + work.Bed[j]);
  }

  // q by q
  J.block(3, 3, k, k) += wa * in.M - wq * w * w * in.D - (wq * wd + wv * 2 * w) * in.B;
  if (in.Q.empty()) return;
  math::multiply_forms(in.Q, edd, work.Qedd);
  J.block(0, 3, 2, k) += A * (wq * (2 * w * quarter * work.Qed + work.Qedd) + 2 * wv * work.Qed);
  J.block(3, 3, k, k) += wq * (Rdd.x() * in.Q[0] + Rdd.y() * in.Q[1] + wd * in.Y);
}

void add_inertia_force(const PlanarInertia& inertia, const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                       const Eigen::VectorXd& a, Eigen::VectorXd& r) {
  InertiaWork work;
  add_inertia_force(inertia, q, v, a, work, r);
}

void add_inertia_tangent(const PlanarInertia& inertia, const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                         const Eigen::VectorXd& a, double wq, double wv, double wa, Eigen::MatrixXd& J) {
  InertiaWork work;
  add_inertia_tangent(inertia, q, v, a, wq, wv, wa, work, J);
}

double kinetic_energy(const PlanarInertia& in, const Eigen::VectorXd& q, const Eigen::VectorXd& v) {
  InertiaWork work;
  products(in, q, v, v, work);
  const auto [sigma, sigma_d, unused] = first_moments(in, work);
  const double w = v[2], moment = in.C0 + 2 * in.h.dot(work.e) + work.e.dot(work.De);
  const Vector2d Rd = rotation(q[2]).transpose() * v.head<2>();
  return 0.5 * (in.m * Rd.squaredNorm() + moment * w * w + work.ed.dot(in.M * work.ed)) +
         Rd.dot(rotated_quarter(sigma) * w + sigma_d) + w * (in.g - work.Be).dot(work.ed);
}

}  // namespace floe::body
