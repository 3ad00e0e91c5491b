#pragma once
#include <Eigen/Dense>

#include "floe/dynamics/system.h"

namespace floe::solve {
using namespace dynamics;

/// The whole matrix, or vector, on every rank. Collective.
Eigen::MatrixXd gather_to_all(const System& system, Mat J);
Eigen::VectorXd gather_to_all(const System& system, Vec x);

/// This rank's part of a vector that every rank knows. Collective.
void set(Vec x, const Eigen::VectorXd& values);

}  // namespace floe::solve
