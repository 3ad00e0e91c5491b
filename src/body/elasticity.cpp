#include "floe/body/elasticity.h"

#include <numeric>

#include "floe/math/matrix_vector.h"

namespace floe::body {
namespace {

void monomials(const Elasticity& e, const Eigen::VectorXd& q, Eigen::VectorXd& z) {
  const Eigen::Index k = q.size();
  z.resize(e.F.cols());
  if (z.size() == 0) return;
  z.head(k) = q;
  for (std::size_t p = 0; p < e.pairs.size(); ++p) {
    const auto [a, b] = e.pairs[p];
    z[k + p] = a == b ? 0.5 * q[a] * q[a] : q[a] * q[b];
  }
}

/// y = F z, w = F'y: stresses and their pull-back.
void stresses(const Elasticity& e, const Eigen::VectorXd& q, ElasticityWork& work) {
  monomials(e, q, work.z);
  work.y.resize(e.F.rows()), work.w.resize(e.F.cols());
  math::multiply(e.F, work.z, work.y);
  math::multiply_transposed(e.F, work.y, work.w);
}

}  // namespace

Eigen::MatrixXd Elasticity::linear_stiffness() const {
  const Eigen::Index k = bending.rows();
  if (F.rows() == 0) return bending;
  return bending + F.leftCols(k).transpose() * F.leftCols(k);
}

double energy(const Elasticity& e, const Eigen::VectorXd& q) {
  double twice = q.dot(e.bending * q);
  if (e.F.rows() > 0) {
    Eigen::VectorXd z;
    monomials(e, q, z);
    twice += (e.F * z).squaredNorm();
  }
  return 0.5 * twice;
}

void add_force(const Elasticity& e, const Eigen::VectorXd& q, ElasticityWork& work, Eigen::Ref<Eigen::VectorXd> f) {
  const Eigen::Index k = q.size();
  f.noalias() += e.bending * q;
  if (e.F.rows() == 0) return;
  stresses(e, q, work);
  f += work.w.head(k);
  for (std::size_t p = 0; p < e.pairs.size(); ++p) {
    const auto [a, b] = e.pairs[p];
    const double w = work.w[k + p];
    f[a] += w * q[b];
    if (a != b) f[b] += w * q[a];
  }
}

void add_tangent(const Elasticity& e, const Eigen::VectorXd& q, double weight, ElasticityWork& work,
                 Eigen::Ref<Eigen::MatrixXd> K) {
  const Eigen::Index k = q.size();
  K += weight * e.bending;
  if (e.F.rows() == 0) return;
  stresses(e, q, work);
  work.T = e.F.leftCols(k);  // T = F dz/dq
  for (std::size_t p = 0; p < e.pairs.size(); ++p) {
    const auto [a, b] = e.pairs[p];
    work.T.col(a) += q[b] * e.F.col(k + p);
    if (a != b) work.T.col(b) += q[a] * e.F.col(k + p);
  }
  K.noalias() += weight * work.T.transpose() * work.T;
  for (std::size_t p = 0; p < e.pairs.size(); ++p) {
    const auto [a, b] = e.pairs[p];
    const double w = weight * work.w[k + p];
    K(a, b) += w;
    if (a != b) K(b, a) += w;
  }
}

Elasticity linearised(const Elasticity& e) { return {e.bending, e.F.leftCols(e.bending.rows()), {}}; }

Elasticity part(const Elasticity& e, int coordinates, const std::vector<char>& kept) {
  const Eigen::Index all = e.bending.rows();
  std::vector<Eigen::Index> columns(coordinates);
  std::iota(columns.begin(), columns.end(), 0);
  Elasticity some;
  some.bending = e.bending.topLeftCorner(coordinates, coordinates);
  for (std::size_t p = 0; p < e.pairs.size(); ++p) {
    if (!kept[p] || e.pairs[p].second >= coordinates) continue;  // pairs a <= b
    some.pairs.push_back(e.pairs[p]);
    columns.push_back(all + static_cast<Eigen::Index>(p));
  }
  some.F = e.F(Eigen::all, columns);
  if (some.F.rows() > some.F.cols()) {
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(some.F);
    some.F = Eigen::MatrixXd(qr.matrixQR().topRows(some.F.cols()).triangularView<Eigen::Upper>());
  }
  return some;
}

}  // namespace floe::body
