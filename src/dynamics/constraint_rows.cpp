#include "floe/dynamics/constraint_rows.h"

#include <algorithm>

namespace floe::dynamics {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

void ConstraintRows::add(std::shared_ptr<const Term> term, std::vector<Index> at, Index rows) {
  entries_.push_back({std::move(term), std::move(at), rows});
  count_ += rows;
}

std::size_t ConstraintRows::term_of(Index row) const {
  std::size_t e = 0;
  for (; row >= entries_[e].rows; ++e) row -= entries_[e].rows;
  return e;
}

VectorXd ConstraintRows::Entry::own(const VectorXd& q) const {
  VectorXd own = VectorXd::Zero(static_cast<Index>(at.size()) + rows);
  own.head(static_cast<Index>(at.size())) = q(at);
  return own;
}

VectorXd ConstraintRows::values(const VectorXd& q, double t, MatrixXd* gradient) const {
  VectorXd C(count_);
  if (gradient) *gradient = MatrixXd::Zero(count_, q.size());
  Index first = 0;
  for (const Entry& entry : entries_) {
    const VectorXd own = entry.own(q), none = VectorXd::Zero(own.size());
    const Index n = static_cast<Index>(entry.at.size());
    const Motion motion{t, own, none, none};
    VectorXd r = none;
    entry.term->residual(motion, r);
    C.segment(first, entry.rows) = r.tail(entry.rows);
    if (gradient) {
      MatrixXd J = MatrixXd::Zero(own.size(), own.size());
      entry.term->tangent(motion, {0, 0, 0}, J);
      for (Index i = 0; i < n; ++i) gradient->block(first, entry.at[i], entry.rows, 1) += J.block(n, i, entry.rows, 1);
    }
    first += entry.rows;
  }
  return C;
}

bool ConstraintRows::satisfied(const VectorXd& q, double t) const {
  return std::all_of(entries_.begin(), entries_.end(), [&](const Entry& entry) {
    const VectorXd own = entry.own(q), none = VectorXd::Zero(own.size());
    return entry.term->constraint_status({t, own, none, none}) == ConstraintStatus::satisfied;
  });
}

}  // namespace floe::dynamics
