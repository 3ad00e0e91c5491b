#pragma once
#include "rotating_axes.h"

namespace floe::solve {

/// Motions that constraints and constrained dofs allow: u = D Q y over the free coordinates, D of unit mass each.
///
/// Q is the end of an orthogonal matrix of few reflections, kept as those.
class AllowedMotions {
 public:
  AllowedMotions(const System& system, const RotatingTangent& at, const Eigen::VectorXd& root_mass);
  /// The same motions with D = 1 / `root`. The reflections mix coordinates, and their round-off is that of the greatest
  /// entries: D ought to make these alike.
  void rescale(const Eigen::VectorXd& root);
  Eigen::Index size() const { return static_cast<Eigen::Index>(free_.size()) - rank_; }
  /// (D Q)' X (D Q) of a matrix over all unknowns.
  Eigen::MatrixXd restrict_both(const Eigen::MatrixXd& X) const;
  /// (D Q)' X.
  Eigen::MatrixXd restrict_rows(const Eigen::MatrixXd& X) const;
  /// D Q y over all unknowns; zero elsewhere.
  Eigen::MatrixXd expand(const Eigen::MatrixXd& y, Eigen::Index unknowns) const;

 private:
  void scale(const Eigen::VectorXd& root);
  Eigen::MatrixXd scaled_gradients() const;

  std::vector<Eigen::Index> free_;  ///< coordinates
  Eigen::MatrixXd gradients_;       ///< of the constraints, each a column over the free coordinates
  Eigen::VectorXd scale_;
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr_;
  Eigen::Index rank_ = 0;
};

}  // namespace floe::solve
