#pragma once
#include "floe/dynamics/term.h"

namespace floe::dynamics {

/// Rows of a joint that does not hold: -lambda = 0. With the sign of a row that holds after the coordinates are
/// eliminated, for those who count the signs of the tangent's eigenvalues.
inline void add_open_rows(const Motion& motion, int first, int count, Eigen::VectorXd& r) {
  if (motion.level != ConstraintLevel::position) return;
  for (int i = first; i < first + count; ++i) r[i] -= motion.q[i];
}

inline void add_open_tangent(int first, int count, Eigen::MatrixXd& J) {
  for (int i = first; i < first + count; ++i) J(i, i) -= 1;
}

}  // namespace floe::dynamics
