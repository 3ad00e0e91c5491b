#pragma once
#include <memory>

#include "floe/dynamics/term.h"

namespace floe::dynamics {

/// The rows C(q, t) of joints one after the other, at the level of positions and without their multipliers, over a
/// numbering of coordinates of its own: for whoever asks which of them depend on others.
class ConstraintRows {
 public:
  /// @param term  its last coordinates are as many multipliers as `rows`
  /// @param at    of its other coordinates, the numbers in q
  void add(std::shared_ptr<const Term> term, std::vector<Eigen::Index> at, Eigen::Index rows);
  Eigen::Index count() const { return count_; }
  /// The number of the term that a row belongs to, in the order added.
  std::size_t term_of(Eigen::Index row) const;
  /// C; if asked, dC/dq, count x size of q.
  Eigen::VectorXd values(const Eigen::VectorXd& q, double t, Eigen::MatrixXd* gradient) const;
  /// Whether every term says that its constraint is satisfied on its own branch (Term::constraint_status).
  bool satisfied(const Eigen::VectorXd& q, double t) const;

 private:
  struct Entry {
    std::shared_ptr<const Term> term;
    std::vector<Eigen::Index> at;
    Eigen::Index rows;
    /// Of the term's coordinates, with multipliers of zero.
    Eigen::VectorXd own(const Eigen::VectorXd& q) const;
  };
  std::vector<Entry> entries_;
  Eigen::Index count_ = 0;
};

}  // namespace floe::dynamics
