#pragma once
#include <Eigen/Dense>
#include <random>

namespace floe::testing {

/// Numbers in (-1, 1): the same on every rank and in every run.
class Random {
 public:
  explicit Random(unsigned seed = 1) : engine_(seed) {}
  double number() { return 2.0 * double(engine_()) / double(std::mt19937::max()) - 1; }
  Eigen::VectorXd vector(Eigen::Index n) { return matrix(n, 1); }
  Eigen::MatrixXd matrix(Eigen::Index rows, Eigen::Index columns) {
    Eigen::MatrixXd m(rows, columns);
    for (Eigen::Index j = 0; j < columns; ++j)
      for (Eigen::Index i = 0; i < rows; ++i) m(i, j) = number();
    return m;
  }

 private:
  std::mt19937 engine_;
};

}  // namespace floe::testing
