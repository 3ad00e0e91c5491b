#include "floe/math/matrix_vector.h"

#include <algorithm>

extern "C" void dgemv_(const char* transposed, const int* rows, const int* columns, const double* factor,
                       const double* A, const int* lead, const double* x, const int* step_x, const double* keep,
                       double* y, const int* step_y);

namespace floe::math {
namespace {

constexpr Eigen::Index worth_a_call = 256;  // entries

void multiply(const char* transposed, const Eigen::Ref<const Eigen::MatrixXd>& A, const double* x, double* y) {
  const int rows = static_cast<int>(A.rows()), columns = static_cast<int>(A.cols());
  const int lead = static_cast<int>(std::max<Eigen::Index>(A.outerStride(), 1)), step = 1;
  const double one = 1, zero = 0;
  dgemv_(transposed, &rows, &columns, &one, A.data(), &lead, x, &step, &zero, y, &step);
}

}  // namespace

void multiply(const Eigen::Ref<const Eigen::MatrixXd>& A, const Eigen::Ref<const Eigen::VectorXd>& x,
              Eigen::Ref<Eigen::VectorXd> y) {
  eigen_assert(A.cols() == x.size() && A.rows() == y.size());
  if (A.size() < worth_a_call)
    y.noalias() = A * x;
  else
    multiply("N", A, x.data(), y.data());
}

void multiply_transposed(const Eigen::Ref<const Eigen::MatrixXd>& A, const Eigen::Ref<const Eigen::VectorXd>& x,
                         Eigen::Ref<Eigen::VectorXd> y) {
  eigen_assert(A.rows() == x.size() && A.cols() == y.size());
  if (A.size() < worth_a_call)
    y.noalias() = A.transpose() * x;
  else
    multiply("T", A, x.data(), y.data());
}

}  // namespace floe::math
