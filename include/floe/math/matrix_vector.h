#pragma once
#include <Eigen/Core>
#include <vector>

namespace floe::math {

/// y = A x by BLAS, whose kernels are made for the processor at hand (Eigen's are for the one that was compiled for).
///
/// @param A  rows x columns, columns stand together (any outer stride)
/// @param y  given with its size; overwritten
void multiply(const Eigen::Ref<const Eigen::MatrixXd>& A, const Eigen::Ref<const Eigen::VectorXd>& x,
              Eigen::Ref<Eigen::VectorXd> y);

/// rows.row(a) = (Q_a x)', Q_a symmetric: the directions that a displacement 1/2 Q(x, x) has at x.
/// @param rows  set to Q.size() x x.size()
template <class Rows>
void multiply_forms(const std::vector<Eigen::MatrixXd>& Q, const Eigen::VectorXd& x, Rows& rows) {
  rows.resize(static_cast<Eigen::Index>(Q.size()), x.size());
  for (std::size_t a = 0; a < Q.size(); ++a) rows.row(static_cast<Eigen::Index>(a)) = x.transpose().lazyProduct(Q[a]);
}

/// y = A'x; as multiply().
void multiply_transposed(const Eigen::Ref<const Eigen::MatrixXd>& A, const Eigen::Ref<const Eigen::VectorXd>& x,
                         Eigen::Ref<Eigen::VectorXd> y);

}  // namespace floe::math
