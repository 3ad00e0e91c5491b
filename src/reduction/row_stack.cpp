#include "row_stack.h"

#include <petscblaslapack.h>

namespace floe::reduction {

void add_product(const RowStack& A, const RowStack& B, Eigen::MatrixXd& C) {
  if (A.range.empty() || B.range.empty() || A.count == 0) return;
  const PetscBLASInt m = A.range.end - A.range.begin, n = B.range.end - B.range.begin, inner = A.count,
                     lead = A.columns, rows = static_cast<int>(C.rows());
  const double one = 1;
  const double *a = A.rows.data() + A.range.begin, *b = B.rows.data() + B.range.begin;
  double* out = &C(A.range.begin, B.range.begin);
  if (&A == &B)
    BLASsyrk_("U", "N", &m, &inner, &one, a, &lead, &one, out, &rows);
  else
    BLASgemm_("N", "T", &m, &n, &inner, &one, a, &lead, b, &lead, &one, out, &rows);
}

void mirror(Eigen::MatrixXd& C) {
  for (Eigen::Index j = 0; j < C.cols(); ++j)
    for (Eigen::Index i = j + 1; i < C.rows(); ++i) C(i, j) = C(j, i);
}

}  // namespace floe::reduction
