#include "null_space.h"

#include <algorithm>
#include <numeric>

namespace floe::solve {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

AllowedMotions::AllowedMotions(const System& system, const RotatingTangent& at, const VectorXd& root_mass) {
  const std::vector<char> is_multiplier = multiplier_flags(system);
  const VectorXd equations = at.G.diagonal();  // of constrained dofs
  std::vector<Index> place(is_multiplier.size(), -1);
  for (Index i = 0; i < at.G.rows(); ++i)
    if (!is_multiplier[i] && equations[i] == 0) {
      place[i] = static_cast<Index>(free_.size());
      free_.push_back(i);
    }
  std::vector<VectorXd> gradients;
  for (Index i = 0; i < at.G.rows(); ++i) {
    if (!is_multiplier[i]) continue;
    VectorXd gradient = VectorXd::Zero(static_cast<Index>(free_.size()));
    for (Sparse::InnerIterator entry(at.G, i); entry; ++entry)
      if (place[entry.col()] >= 0) gradient[place[entry.col()]] = entry.value();
    if (!gradient.isZero(0)) gradients.push_back(std::move(gradient));  // others belong to rows that are left out
  }
  gradients_.resize(static_cast<Index>(free_.size()), static_cast<Index>(gradients.size()));
  for (Index j = 0; j < gradients_.cols(); ++j) gradients_.col(j) = gradients[j];
  scale(root_mass);
  if (gradients_.size() == 0) return;
  qr_.setThreshold(1e-11);
  qr_.compute(scaled_gradients());
  rank_ = qr_.rank();
}

void AllowedMotions::scale(const VectorXd& root) {
  scale_ = root(free_).unaryExpr([](double one) { return one > 0 ? 1 / one : 1.0; });
}

MatrixXd AllowedMotions::scaled_gradients() const {
  MatrixXd gradients = scale_.asDiagonal() * gradients_;
  gradients.colwise().normalize();
  return gradients;
}

void AllowedMotions::rescale(const VectorXd& root) {
  scale(root);
  if (rank_ == 0) return;
  const Eigen::VectorXi independent = qr_.colsPermutation().indices().head(rank_);
  gradients_ = gradients_(Eigen::all, independent).eval();
  // the greatest first, whose round-off must not reach small ones (Cox and Higham 1998, BIT 38)
  const VectorXd greatest = scaled_gradients().cwiseAbs().rowwise().maxCoeff();
  std::vector<Index> order(free_.size()), sorted;
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return greatest[a] > greatest[b]; });
  for (const Index i : order) sorted.push_back(free_[i]);
  free_ = sorted;
  gradients_ = gradients_(order, Eigen::all).eval();
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
