// Eigen's dense decompositions and kernels of products of MatrixXd, compiled once (src/math/compiled_eigen.cpp) and not
// in every file that uses them. It declares nothing new and only saves time in a first build, so no file needs to
// include it; the precompiled headers do. Template parameters of Eigen's internals are those of Eigen 3.4. Included
// twice (no #pragma once): as declarations, and with FLOE_EIGEN_TEMPLATE as definitions.
#include <Eigen/Dense>

#ifndef FLOE_EIGEN_TEMPLATE
#define FLOE_EIGEN_TEMPLATE extern template
#endif

#if EIGEN_VERSION_AT_LEAST(3, 4, 0) && !EIGEN_VERSION_AT_LEAST(3, 4, 90)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wignored-attributes"  // of packets as template arguments
namespace floe::math::compiled {
using Columns = Eigen::internal::const_blas_data_mapper<double, Eigen::Index, Eigen::ColMajor>;
using Rows = Eigen::internal::const_blas_data_mapper<double, Eigen::Index, Eigen::RowMajor>;
using Product = Eigen::internal::gebp_traits<double, double>;
}  // namespace floe::math::compiled

namespace Eigen {
FLOE_EIGEN_TEMPLATE class HouseholderQR<MatrixXd>;
FLOE_EIGEN_TEMPLATE class ColPivHouseholderQR<MatrixXd>;
FLOE_EIGEN_TEMPLATE class CompleteOrthogonalDecomposition<MatrixXd>;
FLOE_EIGEN_TEMPLATE class PartialPivLU<MatrixXd>;
FLOE_EIGEN_TEMPLATE class FullPivLU<MatrixXd>;
FLOE_EIGEN_TEMPLATE class JacobiSVD<MatrixXd>;
FLOE_EIGEN_TEMPLATE class BDCSVD<MatrixXd>;
FLOE_EIGEN_TEMPLATE class GeneralizedSelfAdjointEigenSolver<MatrixXd>;
FLOE_EIGEN_TEMPLATE SelfAdjointEigenSolver<MatrixXd>& SelfAdjointEigenSolver<MatrixXd>::compute(
    const EigenBase<MatrixXd>&, int);
FLOE_EIGEN_TEMPLATE SelfAdjointEigenSolver<Matrix2d>& SelfAdjointEigenSolver<Matrix2d>::compute(
    const EigenBase<Matrix2d>&, int);
FLOE_EIGEN_TEMPLATE SelfAdjointEigenSolver<Matrix3d>& SelfAdjointEigenSolver<Matrix3d>::compute(
    const EigenBase<Matrix3d>&, int);
FLOE_EIGEN_TEMPLATE LDLT<MatrixXd>& LDLT<MatrixXd>::compute(const EigenBase<MatrixXd>&);
FLOE_EIGEN_TEMPLATE LLT<MatrixXd>& LLT<MatrixXd>::compute(const EigenBase<MatrixXd>&);

namespace internal {
namespace compiled = floe::math::compiled;
FLOE_EIGEN_TEMPLATE void tridiagonalization_inplace(MatrixXd&, VectorXd&, VectorXd&, VectorXd&, bool);
FLOE_EIGEN_TEMPLATE ComputationInfo computeFromTridiagonal_impl(VectorXd&, VectorXd&, Index, bool, MatrixXd&);
FLOE_EIGEN_TEMPLATE struct gebp_kernel<double, double, Index, blas_data_mapper<double, Index, ColMajor, Unaligned, 1>,
                                       compiled::Product::mr, compiled::Product::nr, false, false>;
FLOE_EIGEN_TEMPLATE struct gemm_pack_rhs<double, Index, compiled::Columns, compiled::Product::nr, ColMajor, false,
                                         false>;
FLOE_EIGEN_TEMPLATE struct gemm_pack_rhs<double, Index, compiled::Rows, compiled::Product::nr, RowMajor, false, false>;
FLOE_EIGEN_TEMPLATE struct gemm_pack_lhs<double, Index, compiled::Columns, compiled::Product::mr,
                                         compiled::Product::LhsProgress, compiled::Product::LhsPacket4Packing, ColMajor,
                                         false, false>;
FLOE_EIGEN_TEMPLATE struct gemm_pack_lhs<double, Index, compiled::Rows, compiled::Product::mr,
                                         compiled::Product::LhsProgress, compiled::Product::LhsPacket4Packing, RowMajor,
                                         false, false>;
FLOE_EIGEN_TEMPLATE struct general_matrix_vector_product<Index, double, compiled::Columns, ColMajor, false, double,
                                                         compiled::Rows, false, 0>;
FLOE_EIGEN_TEMPLATE struct general_matrix_vector_product<Index, double, compiled::Rows, RowMajor, false, double,
                                                         compiled::Columns, false, 0>;
}  // namespace internal
}  // namespace Eigen
#pragma GCC diagnostic pop
#endif
#undef FLOE_EIGEN_TEMPLATE
