#pragma once
#include <Eigen/Core>
#include <vector>

#include "floe/math/matrix_vector.h"

namespace floe::math {

/// Symmetric matrices Q_a, k x k: a displacement 1/2 Q_a(x, x) of each axis. Those of a few rotations in many
/// coordinates, such as of rigid regions, have a low rank r, and products by their factors Q_a = B' C_a B, B r x k,
/// take k (n + 1) r + n r^2 instead of n k^2 operations.
class SymmetricForms {
 public:
  SymmetricForms() = default;
  SymmetricForms(std::vector<Eigen::MatrixXd> Q) : Q_(std::move(Q)) {}  // NOLINT: implicit, one is the other

  bool empty() const { return Q_.empty(); }
  std::size_t size() const { return Q_.size(); }
  const Eigen::MatrixXd& operator[](std::size_t a) const { return Q_[a]; }

  /// Finds factors where products by them take about a quarter of the operations or less: for forms that are multiplied
  /// often. To round-off the products are the same.
  void factor();
  /// r, or 0 without factors.
  Eigen::Index rank() const { return basis_.rows(); }

  /// rows.row(a) = (Q_a x)': the directions that the displacement has at x.
  /// @param rows  set to size() x x.size()
  template <class Rows>
  void multiply(const Eigen::VectorXd& x, Rows& rows) const {
    if (rank() == 0) return multiply_forms(Q_, x, rows);
    const auto z = (basis_ * x).eval();
    Eigen::Matrix<double, Eigen::Dynamic, Rows::RowsAtCompileTime, 0, most, Rows::RowsAtCompileTime> products(
        rank(), static_cast<Eigen::Index>(size()));
    for (std::size_t a = 0; a < size(); ++a) products.col(static_cast<Eigen::Index>(a)) = small_[a].lazyProduct(z);
    rows = products.transpose().lazyProduct(basis_);
  }

 private:
  static constexpr int most = 16;  ///< of r
  using Basis = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, most, Eigen::Dynamic>;
  using Small = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, most, most>;
  std::vector<Eigen::MatrixXd> Q_;
  Basis basis_;               ///< B, orthonormal rows
  std::vector<Small> small_;  ///< C_a = B Q_a B'
};

}  // namespace floe::math
