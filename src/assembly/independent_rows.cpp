#include "independent_rows.h"

#include <algorithm>

namespace floe::assembly {

std::vector<Eigen::Index> independent_rows(const Eigen::MatrixXd& G, double least) {
  std::vector<Eigen::Index> kept;
  Eigen::MatrixXd basis(G.cols(), 0);
  for (Eigen::Index i = 0; i < G.rows(); ++i) {
    Eigen::VectorXd row = G.row(i).transpose();
    const double size = std::max(row.norm(), least);
    for (int twice = 0; twice < 2; ++twice) row -= basis * (basis.transpose() * row).eval();
    if (!(row.norm() > 1e-8 * size)) continue;
    kept.push_back(i);
    basis.conservativeResize(Eigen::NoChange, basis.cols() + 1);
    basis.rightCols<1>() = row.normalized();
  }
  return kept;
}

}  // namespace floe::assembly
