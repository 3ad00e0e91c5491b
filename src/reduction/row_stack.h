#pragma once
#include <vector>

#include "floe/fem/field_rows.h"

namespace floe::reduction {

/// Rows of k numbers, one after the other, that wait for a product of all of them; zero outside the range.
struct RowStack {
  std::vector<double> rows;
  fem::ColumnRange range;
  int columns = 0, count = 0, room = 0;

  RowStack() = default;
  RowStack(int k, int most) : rows(static_cast<std::size_t>(k) * most), columns(k), room(most) {}
  double* next() { return rows.data() + static_cast<std::ptrdiff_t>(count) * columns; }
  void clear() { range = {}, count = 0; }
};

/// C (k x k) += A'B; where A and B are one, the upper half only.
void add_product(const RowStack& A, const RowStack& B, Eigen::MatrixXd& C);

/// The lower half from the upper one.
void mirror(Eigen::MatrixXd& C);

}  // namespace floe::reduction
