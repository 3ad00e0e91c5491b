#include "null_space.h"

#include <algorithm>
#include <numeric>

namespace floe::solve {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

AllowedMotions::AllowedMotions(const System& system, const RotatingTangent& at, const VectorXd& root_mass) : G_(at.G) {
  const std::vector<char> is_multiplier = multiplier_flags(system);
  for (Index i = 0; i < G_.rows(); ++i)
    if (!is_multiplier[i] && G_(i, i) == 0) free_.push_back(i);  // constrained dofs have an equation of their own
  for (Index i = 0; i < G_.rows(); ++i)
    if (is_multiplier[i] && !G_(i, free_).isZero(0)) rows_.push_back(i);  // others belong to rows that are left out
  scale(root_mass);
  if (rows_.empty() || free_.empty()) return;
  qr_.setThreshold(1e-11);
  qr_.compute(scaled_gradients());
  rank_ = qr_.rank();
}

void AllowedMotions::scale(const VectorXd& root) {
  scale_ = root(free_).unaryExpr([](double one) { return one > 0 ? 1 / one : 1.0; });
}

MatrixXd AllowedMotions::scaled_gradients() const {
  MatrixXd gradients = scale_.asDiagonal() * G_(rows_, free_).transpose();
  gradients.colwise().normalize();
  return gradients;
}

void AllowedMotions::rescale(const VectorXd& root) {
  scale(root);
  if (rank_ == 0) return;
  std::vector<Index> independent, order(free_.size()), sorted;
  for (Index i = 0; i < rank_; ++i) independent.push_back(rows_[qr_.colsPermutation().indices()[i]]);
  rows_ = independent;
  // the greatest first, whose round-off must not reach small ones (Cox and Higham 1998, BIT 38)
  const VectorXd greatest = scaled_gradients().cwiseAbs().rowwise().maxCoeff();
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return greatest[a] > greatest[b]; });
  for (const Index i : order) sorted.push_back(free_[i]);
  free_ = sorted;
  scale(root);
  qr_.compute(scaled_gradients());
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
