#include "floe/body/spatial_frame.h"

#include "floe/math/matrix_vector.h"
#include "floe/math/rotation.h"

namespace floe::body {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using Rates = SpatialInertiaWork::Rates;

/// S x, without the set-up of a general product.
template <class Vector>
Vector3d times(const Eigen::Matrix3Xd& S, const Vector& x) {
  Vector3d sum = Vector3d::Zero();
  for (Index j = 0; j < S.cols(); ++j) sum += x[j] * S.col(j);
  return sum;
}

/// What forms from `first` on, times x, add to dJ/de, G and Y e.
void add_products(const SpatialInertia& in, int first, const Eigen::VectorXd& x, Eigen::VectorXd& products,
                  Rates& rates) {
  const Index k = in.S.cols(), n = static_cast<Index>(in.kinds.size()) - first;
  if (k == 0 || n == 0) return;
  if (products.size() < k * n) products.resize(k * n);
  math::multiply_transposed(in.forms.rightCols(k * n), x, products.head(k * n));
  for (Index i = 0; i < n; ++i) {
    const auto product = products.segment(i * k, k);
    const int kind = in.kinds[first + i];
    if (kind >= 9) {
      rates.col(kind) += product;
    } else if (kind >= 3) {
      rates.col(kind) -= product;  // skew forms: F'x = -F x
    } else {
      rates.col((kind + 1) % 3) += 2 * product;
      rates.col((kind + 2) % 3) += 2 * product;
    }
  }
}

/// dJ/de and G at e; products of B and Y alone (`skew`) or of all forms with the velocities.
void set_rates(const SpatialInertia& in, const Eigen::VectorXd& q, const Eigen::VectorXd& v, const Eigen::VectorXd& a,
               bool skew, SpatialInertiaWork& work) {
  const Index k = in.S.cols();
  work.e = q.tail(k), work.ed = v.tail(k), work.edd = a.tail(k);
  work.of_e.resize(k, 12);
  work.of_e.leftCols<9>() = in.linear;
  work.of_e.rightCols<3>().setZero();
  work.of_ed.setZero(k, 12);
  add_products(in, 0, work.e, work.products, work.of_e);
  add_products(in, skew ? in.symmetric : 0, work.ed, work.products, work.of_ed);
  if (in.Q.empty()) return;
  in.Q.multiply(work.e, work.S);
  work.S += in.S;
  in.Q.multiply(work.ed, work.Qed);
}

/// S(e).
const Eigen::Matrix3Xd& first_moments(const SpatialInertia& in, const SpatialInertiaWork& work) {
  return in.Q.empty() ? in.S : work.S;
}

Matrix3d symmetric(double xx, double yy, double zz, double yz, double zx, double xy) {
  return (Matrix3d() << xx, xy, zx, xy, yy, yz, zx, yz, zz).finished();
}

/// J_i.
Matrix3d moment_rate(const Rates& rates, Index i) {
  return symmetric(rates(i, 0), rates(i, 1), rates(i, 2), rates(i, 3), rates(i, 4), rates(i, 5));
}

/// G_i but for (Y e)_i, and that.
Vector3d spin_rate(const Rates& rates, Index i) { return {rates(i, 6), rates(i, 7), rates(i, 8)}; }
Vector3d rotation_rate(const Rates& rates, Index i) { return {rates(i, 9), rates(i, 10), rates(i, 11)}; }

/// What e and e' make of the body as a whole.
struct Sums {
  Vector3d sigma, sigma_d, sigma_dd;  ///< and its rates in body axes
  Matrix3d J, J_d;                    ///< and its rate
  Vector3d spin;                      ///< G e'
  Vector3d rotation;                  ///< Y(e', e')
};

Sums sums_of(const SpatialInertia& in, const SpatialInertiaWork& work) {
  const auto &e = work.e, &ed = work.ed;
  double J[6] = {0, 0, 0, 0, 0, 0}, rate[9] = {0, 0, 0, 0, 0, 0, 0, 0, 0};
  Vector3d rotation;
  for (int c = 0; c < 9; ++c) rate[c] = ed.dot(work.of_e.col(c));
  for (int c = 0; c < 3; ++c) {
    rate[6 + c] += ed.dot(work.of_e.col(9 + c));
    rotation[c] = ed.dot(work.of_ed.col(9 + c));
  }
  for (int c = 0; c < 6; ++c) J[c] = 0.5 * (e.dot(in.linear.col(c)) + e.dot(work.of_e.col(c)));
  const Eigen::Matrix3Xd& S = first_moments(in, work);
  Vector3d sigma = in.s0 + times(S, e), sigma_dd = times(S, work.edd);
  if (!in.Q.empty()) {
    sigma += 0.5 * (times(in.S, e) - times(S, e));
    sigma_dd += times(work.Qed, ed);
  }
  return {sigma,
          times(S, ed),
          sigma_dd,
          in.J0 + symmetric(J[0], J[1], J[2], J[3], J[4], J[5]),
          symmetric(rate[0], rate[1], rate[2], rate[3], rate[4], rate[5]),
          Vector3d(rate[6], rate[7], rate[8]),
          rotation};
}

/// The acceleration of the mass relative to the frame's origin: body axes, times mass.
Vector3d relative_acceleration(const Sums& s, const Vector3d& w, const Vector3d& wd) {
  return wd.cross(s.sigma) + w.cross(w.cross(s.sigma)) + 2 * w.cross(s.sigma_d) + s.sigma_dd;
}

/// The e by e block but for M: all forms, each with its weight.
void add_forms(const SpatialInertia& in, const Matrix3d& squares, const Vector3d& skew, const Vector3d& rotation,
               Eigen::VectorXd& sum, Eigen::MatrixXd& tangent) {
  const Index k = in.S.cols(), n = static_cast<Index>(in.kinds.size());
  if (k == 0 || n == 0) return;
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 12, 1> weights(n);
  for (Index i = 0; i < n; ++i) {
    const int kind = in.kinds[i], axis = kind % 3;
    if (kind < 3)
      weights[i] = squares(axis, axis);
    else if (kind < 6)
      weights[i] = squares((axis + 1) % 3, (axis + 2) % 3);
    else
      weights[i] = kind < 9 ? skew[axis] : rotation[axis];
  }
  sum.resize(k * k);
  math::multiply(Eigen::Map<const Eigen::MatrixXd>(in.forms.data(), k * k, n), weights, sum);
  tangent.bottomRightCorner(k, k) += Eigen::Map<const Eigen::MatrixXd>(sum.data(), k, k);
}

/// What the change of S with e adds to the tangent.
void add_arms(const SpatialInertia& in, const Matrix3d& A, const Vector3d& u, const Vector3d& w, double wq, double wv,
              SpatialInertiaWork& work, Eigen::MatrixXd& tangent) {
  const Index k = in.S.cols();
  in.Q.multiply(work.edd, work.Qedd);
  tangent.topRightCorner(3, k) += A * (wq * (2 * math::skew(w) * work.Qed + work.Qedd) + 2 * wv * work.Qed);
  for (int a = 0; a < 3; ++a) tangent.bottomRightCorner(k, k) += wq * u[a] * in.Q[a];
}

}  // namespace

void add_spatial_inertia_force(const SpatialInertia& in, const Matrix3d& A, const Eigen::VectorXd& q,
                               const Eigen::VectorXd& v, const Eigen::VectorXd& a, SpatialInertiaWork& work,
                               Eigen::VectorXd& r) {
  const Index k = in.S.cols();
  set_rates(in, q, v, a, true, work);
  const Sums s = sums_of(in, work);
  const Vector3d w = v.segment<3>(3), wd = a.segment<3>(3), u = A.transpose() * a.head<3>();
  r.head<3>() += in.m * a.head<3>() + A * relative_acceleration(s, w, wd);
  Vector3d moment = s.sigma.cross(u) + s.J * wd + s.J_d * w + s.rotation + w.cross(s.J * w + s.spin);
  for (int c = 0; c < 3; ++c) moment[c] += work.edd.dot(work.of_e.col(6 + c) + work.of_e.col(9 + c));
  r.segment<3>(3) += moment;
  work.Medd.resize(k);
  math::multiply(in.M, work.edd, work.Medd);
  // G_i.alpha - 1/2 omega.J_i omega, column by column
  const double by_rates[12] = {-0.5 * w[0] * w[0],
                               -0.5 * w[1] * w[1],
                               -0.5 * w[2] * w[2],
                               -w[1] * w[2],
                               -w[2] * w[0],
                               -w[0] * w[1],
                               wd[0],
                               wd[1],
                               wd[2],
                               wd[0],
                               wd[1],
                               wd[2]};
  auto rows = r.tail(k);
  rows += work.Medd;
  for (int c = 0; c < 12; ++c) rows += by_rates[c] * work.of_e.col(c);
  for (int c = 0; c < 3; ++c) rows += 2 * w[c] * work.of_ed.col(6 + c);
  const Eigen::Matrix3Xd& S = first_moments(in, work);
  for (Index i = 0; i < k; ++i) rows[i] += S.col(i).dot(u);
}

void add_spatial_inertia_tangent(const SpatialInertia& in, const Matrix3d& A, const Eigen::VectorXd& q,
                                 const Eigen::VectorXd& v, const Eigen::VectorXd& a, double wq, double wv, double wa,
                                 SpatialInertiaWork& work, Eigen::MatrixXd& tangent) {
  using math::skew;
  const Index k = in.S.cols();
  set_rates(in, q, v, a, wq == 0, work);
  work.of_edd.setZero(k, 12);
  if (wq != 0) add_products(in, in.symmetric, work.edd, work.products, work.of_edd);
  const Sums s = sums_of(in, work);
  const Vector3d w = v.segment<3>(3), wd = a.segment<3>(3), u = A.transpose() * a.head<3>();
  const Matrix3d I = Matrix3d::Identity(), rotation = skew(w), squares = rotation * rotation, of_sigma = skew(s.sigma);
  const Matrix3d T = wq * math::rotation_tangent(q.segment<3>(3));

  // frame by frame
  const Vector3d relative = relative_acceleration(s, w, wd);
  tangent.block<3, 3>(0, 0) += wa * in.m * I;
  tangent.block<3, 3>(0, 3) +=
      A * (wv * (w.dot(s.sigma) * I + w * s.sigma.transpose() - 2 * s.sigma * w.transpose() - 2 * skew(s.sigma_d)) -
           wa * of_sigma - skew(relative) * T);
  tangent.block<3, 3>(3, 0) += wa * of_sigma * A.transpose();
  tangent.block<3, 3>(3, 3) +=
      wv * (rotation * s.J - skew(s.J * w + s.spin) + s.J_d) + wa * s.J + of_sigma * skew(u) * T;

  // frame by e and e by frame
  const Eigen::Matrix3Xd& all_S = first_moments(in, work);
  const Matrix3d on_S = A * (wa * I + wq * (skew(wd) + squares) + 2 * wv * rotation);
  for (Index i = 0; i < k; ++i) {
    const Vector3d S = all_S.col(i), G = spin_rate(work.of_e, i) + rotation_rate(work.of_e, i);
    const Vector3d Bed = spin_rate(work.of_ed, i), Yed = rotation_rate(work.of_ed, i);
    const Matrix3d J = moment_rate(work.of_e, i);
    const Vector3d Jw = J * w, across = S.cross(u);
    tangent.block<3, 1>(0, 6 + i) += on_S * S;
    tangent.block<1, 3>(6 + i, 0) += wa * (A * S).transpose();
    tangent.block<3, 1>(3, 6 + i) +=
        wq * (across + J * wd + moment_rate(work.of_ed, i) * w - spin_rate(work.of_edd, i) +
              rotation_rate(work.of_edd, i) + w.cross(Jw - Bed + Yed)) +
        wv * (Jw + 2 * Yed + w.cross(G)) + wa * G;
    tangent.block<1, 3>(6 + i, 3) += (wv * (2 * Bed - Jw) + wa * G + T.transpose() * across).transpose();
  }

  if (!in.Q.empty()) add_arms(in, A, u, w, wq, wv, work, tangent);
  if (wa != 0) tangent.bottomRightCorner(k, k) += wa * in.M;
  add_forms(in, wq * squares, wq * wd + 2 * wv * w, wq * wd, work.sum, tangent);
}

double kinetic_energy(const SpatialInertia& in, const Matrix3d& A, const Eigen::VectorXd& q, const Eigen::VectorXd& v) {
  SpatialInertiaWork work;
  set_rates(in, q, v, v, true, work);
  const Sums s = sums_of(in, work);
  const Vector3d w = v.segment<3>(3), Rd = A.transpose() * v.head<3>();
  return 0.5 * (in.m * Rd.squaredNorm() + w.dot(s.J * w) + work.ed.dot(in.M * work.ed)) +
         Rd.dot(w.cross(s.sigma) + s.sigma_d) + w.dot(s.spin);
}

Momentum momentum(const SpatialInertia& in, const Matrix3d& A, const Eigen::VectorXd& q, const Eigen::VectorXd& v) {
  SpatialInertiaWork work;
  set_rates(in, q, v, v, true, work);
  const Sums s = sums_of(in, work);
  const Vector3d w = v.segment<3>(3), Rd = A.transpose() * v.head<3>(), R = q.head<3>();
  const Vector3d linear = A * (in.m * Rd + w.cross(s.sigma) + s.sigma_d);
  return {linear, R.cross(linear) + A * (s.sigma.cross(Rd) + s.J * w + s.spin)};
}

}  // namespace floe::body
