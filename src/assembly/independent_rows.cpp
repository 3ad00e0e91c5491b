#include "independent_rows.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

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

std::vector<Eigen::Index> undetermined_rows(const Eigen::MatrixXd& G, const std::vector<Eigen::Index>& kept) {
  std::vector<Eigen::Index> rows;
  const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> by_kept(G(kept, Eigen::all).transpose());
  for (Eigen::Index i = 0; i < G.rows(); ++i) {
    if (std::binary_search(kept.begin(), kept.end(), i)) continue;
    rows.push_back(i);
    if (kept.empty()) continue;
    const Eigen::VectorXd share = by_kept.solve(G.row(i).transpose());
    for (Eigen::Index k = 0; k < share.size(); ++k)
      if (std::abs(share[k]) > 1e-6) rows.push_back(kept[static_cast<std::size_t>(k)]);
  }
  std::sort(rows.begin(), rows.end());
  rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
  return rows;
}

}  // namespace floe::assembly
