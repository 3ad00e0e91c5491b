#pragma once
#include <Eigen/Core>
#include <vector>

namespace floe::math {

/// Rows in order, each if it is independent of those kept before it (relative 1e-8).
/// @param least  rows shorter than 1e-8 of it are round-off
std::vector<Eigen::Index> independent_rows(const Eigen::MatrixXd& G, double least = 0);

/// Rows whose multipliers G' lambda = f does not determine: those that are not kept, and those that they depend on.
std::vector<Eigen::Index> undetermined_rows(const Eigen::MatrixXd& G, const std::vector<Eigen::Index>& kept);

}  // namespace floe::math
