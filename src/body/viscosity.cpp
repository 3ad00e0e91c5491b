#include "floe/body/viscosity.h"

#include "floe/math/matrix_vector.h"

namespace floe::body {
namespace {

/// y = T v = F dz/dt, w = F'y.
void stress_rates(const Elasticity& e, const Eigen::VectorXd& q, const Eigen::VectorXd& v, ViscosityWork& work) {
  const Eigen::Index k = q.size();
  work.zd.resize(e.F.cols()), work.y.resize(e.F.rows()), work.w.resize(e.F.cols());
  work.zd.head(k) = v;
  for (std::size_t p = 0; p < e.pairs.size(); ++p) {
    const auto [a, b] = e.pairs[p];
    work.zd[k + p] = a == b ? q[a] * v[a] : q[a] * v[b] + q[b] * v[a];
  }
  math::multiply(e.F, work.zd, work.y);
  math::multiply_transposed(e.F, work.y, work.w);
}

/// T += sum over the pairs of x_b F_ab in column a, and x_a F_ab in column b.
void add_pairs(const Elasticity& e, const Eigen::VectorXd& x, Eigen::MatrixXd& T) {
  const Eigen::Index k = x.size();
  for (std::size_t p = 0; p < e.pairs.size(); ++p) {
    const auto [a, b] = e.pairs[p];
    T.col(a) += x[b] * e.F.col(k + p);
    if (a != b) T.col(b) += x[a] * e.F.col(k + p);
  }
}

}  // namespace

void add_viscous_force(const Elasticity& e, const Eigen::VectorXd& q, const Eigen::VectorXd& v, double weight,
                       ViscosityWork& work, Eigen::Ref<Eigen::VectorXd> f) {
  f.noalias() += weight * (e.bending * v);
  if (e.F.rows() == 0) return;
  stress_rates(e, q, v, work);
  f += weight * work.w.head(q.size());
  for (std::size_t p = 0; p < e.pairs.size(); ++p) {
    const auto [a, b] = e.pairs[p];
    const double w = weight * work.w[q.size() + static_cast<Eigen::Index>(p)];
    f[a] += w * q[b];
    if (a != b) f[b] += w * q[a];
  }
}

void add_viscous_tangent(const Elasticity& e, const Eigen::VectorXd& q, const Eigen::VectorXd& v, double wq, double wv,
                         ViscosityWork& work, Eigen::Ref<Eigen::MatrixXd> K) {
  const Eigen::Index k = q.size();
  K += wv * e.bending;
  if (e.F.rows() == 0) return;
  work.T = e.F.leftCols(k);
  add_pairs(e, q, work.T);
  if (wv != 0) K.noalias() += wv * work.T.transpose() * work.T;
  if (wq == 0 || e.pairs.empty()) return;
  stress_rates(e, q, v, work);
  work.U.setZero(e.F.rows(), k);
  add_pairs(e, v, work.U);
  K.noalias() += wq * work.T.transpose() * work.U;
  for (std::size_t p = 0; p < e.pairs.size(); ++p) {
    const auto [a, b] = e.pairs[p];
    const double w = wq * work.w[k + static_cast<Eigen::Index>(p)];
    K(a, b) += w;
    if (a != b) K(b, a) += w;
  }
}

}  // namespace floe::body
