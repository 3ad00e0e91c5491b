#pragma once
#include <Eigen/Dense>
#include <algorithm>
#include <vector>

namespace floe::dynamics {

/// Where `indices` stand among `all`, which receives those it lacks.
inline std::vector<int> place_all(const std::vector<int>& indices, std::vector<int>& all) {
  std::vector<int> where;
  for (int index : indices) {
    const auto found = std::find(all.begin(), all.end(), index);
    where.push_back(static_cast<int>(found - all.begin()));
    if (found == all.end()) all.push_back(index);
  }
  return where;
}

/// to_i = from[where_i]
inline void pick(const std::vector<int>& where, const Eigen::VectorXd& from, Eigen::VectorXd& to) {
  to.resize(static_cast<Eigen::Index>(where.size()));
  for (std::size_t i = 0; i < where.size(); ++i) to[i] = from[where[i]];
}

}  // namespace floe::dynamics
