#include "floe/math/independent_rows.h"

#include <Eigen/Dense>
#include <algorithm>

namespace floe::math {

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

std::vector<Eigen::Index> undetermined_rows(const Eigen::MatrixXd& G, const std::vector<Eigen::Index>& kept) {
  std::vector<Eigen::Index> rows;
  for (Eigen::Index i = 0; i < G.rows(); ++i)
    if (!std::binary_search(kept.begin(), kept.end(), i)) rows.push_back(i);
  if (rows.empty() || kept.empty()) return rows;
  const Eigen::MatrixXd left_out = G(rows, Eigen::all), by = G(kept, Eigen::all);
  const Eigen::MatrixXd share = by.transpose().completeOrthogonalDecomposition().solve(left_out.transpose());
  for (std::size_t k = 0; k < kept.size(); ++k)
    if (share.row(static_cast<Eigen::Index>(k)).cwiseAbs().maxCoeff() > 1e-6) rows.push_back(kept[k]);
  std::sort(rows.begin(), rows.end());
  return rows;
}

}  // namespace floe::math
