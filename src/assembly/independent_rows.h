#pragma once
#include <Eigen/Core>
#include <vector>

namespace floe::assembly {

/// Rows in order, each if it is independent of those kept before it (relative 1e-8).
/// @param least  rows shorter than 1e-8 of it are round-off
std::vector<Eigen::Index> independent_rows(const Eigen::MatrixXd& G, double least = 0);

}  // namespace floe::assembly
