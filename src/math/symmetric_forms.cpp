#include "floe/math/symmetric_forms.h"

#include <Eigen/QR>

namespace floe::math {

void SymmetricForms::factor() {
  basis_.resize(0, 0), small_.clear();
  if (Q_.empty() || Q_.front().size() == 0) return;
  const Eigen::Index k = Q_.front().rows(), n = static_cast<Eigen::Index>(Q_.size());
  Eigen::MatrixXd all(k, n * k);
  for (Eigen::Index a = 0; a < n; ++a) all.middleCols(a * k, k) = Q_[static_cast<std::size_t>(a)];
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(all);
  const Eigen::Index r = qr.rank();
  if (r == 0 || r > most || 4 * (n + 1) * r > n * k) return;
  const Eigen::MatrixXd range = qr.householderQ() * Eigen::MatrixXd::Identity(k, r);
  basis_ = range.transpose();
  for (const Eigen::MatrixXd& Q : Q_) small_.emplace_back(range.transpose() * Q * range);
}

}  // namespace floe::math
