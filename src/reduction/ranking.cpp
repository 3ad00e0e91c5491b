#include "floe/reduction/ranking.h"

#include "floe/reduction/basis.h"

namespace floe::reduction {
namespace {

/// Coordinates of the candidates in the complement of `given`, one column each; `norms` receives their M-norms.
Eigen::MatrixXd new_parts(const fem::Structure& structure, const Columns& given, const Columns& candidates,
                          Eigen::VectorXd& norms) {
  Columns all;
  for (const auto& column : given) all.push_back(copy(column));
  for (const auto& column : candidates) all.push_back(copy(column));
  const Basis basis = orthonormal_basis(structure, all, std::vector<ColumnOrigin>(all.size()), 1e-12);
  Eigen::Index spanned = 0;
  for (std::size_t i = 0; i < given.size(); ++i) spanned += basis.origins[i].kept;
  Eigen::MatrixXd coordinates(basis.columns, static_cast<Eigen::Index>(candidates.size()));
  for (std::size_t c = 0; c < candidates.size(); ++c)
    petsc::check(BVDotVec(basis.V, candidates[c], coordinates.col(static_cast<Eigen::Index>(c)).data()));
  norms = coordinates.colwise().norm();
  return coordinates.bottomRows(basis.columns - spanned);
}

}  // namespace

std::vector<Ranked> rank(const fem::Structure& structure, const Columns& given, const Columns& candidates,
                         const std::vector<double>& factors, int count, double tolerance) {
  std::vector<Ranked> taken;
  if (candidates.empty()) return taken;
  Eigen::VectorXd norms;
  Eigen::MatrixXd left = new_parts(structure, given, candidates, norms);
  const Eigen::Map<const Eigen::VectorXd> factor(factors.data(), left.cols());
  while (static_cast<int>(taken.size()) < count) {
    const Eigen::VectorXd sizes = left.colwise().norm();
    const Eigen::VectorXd weights = (sizes.array() > tolerance * norms.array()).select(factor.cwiseProduct(sizes), 0);
    Eigen::Index best = 0;
    if (weights.maxCoeff(&best) <= 0) break;
    taken.push_back({static_cast<std::size_t>(best), weights[best]});
    const Eigen::VectorXd direction = left.col(best) / sizes[best];
    for (int twice = 0; twice < 2; ++twice) left -= direction * (direction.transpose() * left).eval();
    left.col(best).setZero();
  }
  for (std::size_t i = taken.size(); i-- > 0;) taken[i].weight /= taken[0].weight;
  return taken;
}

}  // namespace floe::reduction
