#pragma once
#include <Eigen/Dense>
#include <Eigen/Sparse>

#include "floe/dynamics/system.h"

namespace floe::solve {
using namespace dynamics;

/// Rows are contiguous, with indices as PETSc's.
using Sparse = Eigen::SparseMatrix<double, Eigen::RowMajor, PetscInt>;

/// The whole matrix (entries that are not zero), or vector, on every rank. Collective.
Sparse gather_to_all(const System& system, Mat J);
Eigen::VectorXd gather_to_all(const System& system, Vec x);

/// This rank's part of a vector that every rank knows. Collective.
void set(Vec x, const Eigen::VectorXd& values);

}  // namespace floe::solve
