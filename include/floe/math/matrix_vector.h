#pragma once
#include <Eigen/Core>

namespace floe::math {

/// y = A x by BLAS, whose kernels are made for the processor at hand (Eigen's are for the one that was compiled for).
///
/// @param A  rows x columns, columns stand together (any outer stride)
/// @param y  given with its size; overwritten
void multiply(const Eigen::Ref<const Eigen::MatrixXd>& A, const Eigen::Ref<const Eigen::VectorXd>& x,
              Eigen::Ref<Eigen::VectorXd> y);

/// y = A'x; as multiply().
void multiply_transposed(const Eigen::Ref<const Eigen::MatrixXd>& A, const Eigen::Ref<const Eigen::VectorXd>& x,
                         Eigen::Ref<Eigen::VectorXd> y);

}  // namespace floe::math
