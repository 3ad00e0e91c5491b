#include "null_space.h"

namespace floe::solve {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

AllowedMotions::AllowedMotions(const System& system, const RotatingTangent& at, const VectorXd& root_mass) {
  const std::vector<char> is_multiplier = multiplier_flags(system);
  std::vector<Index> rows;
  for (Index i = 0; i < at.G.rows(); ++i)
    if (!is_multiplier[i] && at.G(i, i) == 0) free_.push_back(i);  // constrained dofs have an equation of their own
  scale_ = root_mass(free_).unaryExpr([](double root) { return root > 0 ? 1 / root : 1.0; });
  for (Index i = 0; i < at.G.rows(); ++i)
    if (is_multiplier[i] && !at.G(i, free_).isZero(0)) rows.push_back(i);  // others belong to rows that are left out
  if (rows.empty() || free_.empty()) return;
  MatrixXd gradients = scale_.asDiagonal() * at.G(rows, free_).transpose();
  gradients.colwise().normalize();
  qr_.setThreshold(1e-11);
  qr_.compute(gradients);
  rank_ = qr_.rank();
}

MatrixXd AllowedMotions::restrict_rows(const MatrixXd& X) const {
  MatrixXd all = scale_.asDiagonal() * X(free_, Eigen::all);
  if (rank_ > 0) all.applyOnTheLeft(qr_.householderQ().setLength(rank_).adjoint());
  return all.bottomRows(size());
}

MatrixXd AllowedMotions::expand(const MatrixXd& y, Index unknowns) const {
  MatrixXd all = MatrixXd::Zero(static_cast<Index>(free_.size()), y.cols());
  all.bottomRows(size()) = y;
  if (rank_ > 0) all.applyOnTheLeft(qr_.householderQ().setLength(rank_));
  MatrixXd u = MatrixXd::Zero(unknowns, y.cols());
  u(free_, Eigen::all) = scale_.asDiagonal() * all;
  return u;
}

MatrixXd AllowedMotions::restrict_both(const MatrixXd& X) const {
  const MatrixXd half = restrict_rows(X);
  return restrict_rows(half.transpose()).transpose();
}

}  // namespace floe::solve
