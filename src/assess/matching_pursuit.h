#pragma once
#include <Eigen/Dense>
#include <vector>

namespace floe::assess {

/// Candidates of one body for what its motion needs: directions d_c (columns of D), and Y with a column for each
/// instant, both in coordinates in which the norm is the one that counts.
struct Directions {
  Eigen::MatrixXd D, Y;
  std::vector<int> group;  ///< of each direction: what is taken is taken in all bodies together
};

struct Taken {
  int group;
  double share;  ///< of sum |Y|^2
};

/// Takes groups one after another, each the one that carries most of Y besides those before it, until nothing is left
/// that carries more than 1e-14 of it.
std::vector<Taken> matching_pursuit(std::vector<Directions> bodies, int groups);

}  // namespace floe::assess
