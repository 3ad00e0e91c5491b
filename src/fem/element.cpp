#include "floe/fem/element.h"

#include <cmath>

namespace floe::fem {
namespace {

/// D^(1/2) with D^(1/2)' D^(1/2) = D, for D symmetric positive semi-definite.
Eigen::MatrixXd root(const Eigen::MatrixXd& D) {
  if (D.size() == 1) return D.cwiseSqrt();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(D);
  return eigen.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal() * eigen.eigenvectors().transpose();
}

}  // namespace

Eigen::VectorXd StrainPoint::bilinear(const Eigen::VectorXd& slope_a, const Eigen::VectorXd& slope_b) const {
  Eigen::VectorXd e(P.size());
  for (std::size_t s = 0; s < P.size(); ++s) e[s] = slope_a.dot(P[s] * slope_b);
  return e;
}

Eigen::MatrixXd ElementMaps::stiffness() const {
  Eigen::MatrixXd K = bending;
  for (const StrainPoint& g : membrane) K.noalias() += g.weight * g.L.transpose() * g.D * g.L;
  return K;
}

Eigen::MatrixXd ElementMaps::tangent(const Eigen::VectorXd& q) const {
  Eigen::MatrixXd K = bending;
  for (const StrainPoint& g : membrane) {
    const Eigen::VectorXd slope = g.G * q;
    const Eigen::VectorXd stress = g.D * (g.L * q + 0.5 * g.bilinear(slope, slope));
    Eigen::MatrixXd E = g.L, curved = Eigen::MatrixXd::Zero(g.G.rows(), g.G.rows());
    for (std::size_t s = 0; s < g.P.size(); ++s) {
      E.row(static_cast<Eigen::Index>(s)).noalias() += (g.P[s] * slope).transpose() * g.G;
      curved += stress[static_cast<Eigen::Index>(s)] * g.P[s];
    }
    K.noalias() += g.weight * (E.transpose() * g.D * E + g.G.transpose() * curved * g.G);
  }
  return K;
}

Eigen::MatrixXd ElementMaps::mass_matrix() const {
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(bending.rows(), bending.rows());
  for (const body::MassPoint& point : mass) M.noalias() += point.mass * point.N.transpose() * point.N;
  return M;
}

Eigen::VectorXd stiffness_derivative(const ElementMaps& maps, const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  Eigen::VectorXd f = Eigen::VectorXd::Zero(a.size());
  for (const StrainPoint& g : maps.membrane) {
    const Eigen::VectorXd slope_a = g.G * a, slope_b = g.G * b;
    const Eigen::VectorXd stress_a = g.D * (g.L * a), stress_b = g.D * (g.L * b);
    f.noalias() += g.weight * g.L.transpose() * (g.D * g.bilinear(slope_a, slope_b));
    for (std::size_t s = 0; s < g.P.size(); ++s)
      f.noalias() += g.weight * g.G.transpose() * (g.P[s] * (stress_b[s] * slope_a + stress_a[s] * slope_b));
  }
  return f;
}

std::vector<std::pair<int, int>> pairs_of(const std::vector<int>& sloped) {
  std::vector<std::pair<int, int>> pairs;
  for (std::size_t i = 0; i < sloped.size(); ++i)
    for (std::size_t j = i; j < sloped.size(); ++j) pairs.emplace_back(sloped[i], sloped[j]);
  return pairs;
}

Eigen::MatrixXd strain_rows(const ElementMaps& maps, const Eigen::MatrixXd& V,
                            const std::vector<std::pair<int, int>>& pairs) {
  const Eigen::Index k = V.cols();
  Eigen::Index count = 0;
  for (const StrainPoint& g : maps.membrane) count += g.L.rows();
  Eigen::MatrixXd H(count, k + static_cast<Eigen::Index>(pairs.size()));
  Eigen::Index row = 0;
  for (const StrainPoint& g : maps.membrane) {
    const Eigen::Index s = g.L.rows();
    auto rows = H.middleRows(row, s);
    rows.leftCols(k).noalias() = g.L * V;
    if (!pairs.empty()) {
      const Eigen::MatrixXd slopes = g.G * V;
      for (Eigen::Index i = 0; i < s; ++i) {
        const Eigen::MatrixXd e = slopes.transpose() * g.P[static_cast<std::size_t>(i)].lazyProduct(slopes);
        for (std::size_t p = 0; p < pairs.size(); ++p) rows(i, k + p) = e(pairs[p].first, pairs[p].second);
      }
    }
    rows = (std::sqrt(g.weight) * root(g.D) * rows).eval();
    row += s;
  }
  return H;
}

body::Elasticity elasticity(const ElementMaps& maps, const Eigen::MatrixXd& V) {
  std::vector<char> slope(V.cols(), 0);
  for (const StrainPoint& g : maps.membrane) {
    const Eigen::MatrixXd slopes = g.G * V;
    for (Eigen::Index a = 0; a < V.cols(); ++a) slope[a] |= !slopes.col(a).isZero(0);
  }
  std::vector<int> sloped;
  for (int a = 0; a < V.cols(); ++a)
    if (slope[a]) sloped.push_back(a);
  body::Elasticity e;
  e.bending = V.transpose() * maps.bending * V;
  const std::vector<std::pair<int, int>> all = pairs_of(sloped);
  e.F = strain_rows(maps, V, all);
  Eigen::Index columns = V.cols();
  for (std::size_t p = 0; p < all.size(); ++p) {  // without those that strain nothing
    const auto column = e.F.col(V.cols() + static_cast<Eigen::Index>(p));
    if (column.isZero(0)) continue;
    e.F.col(columns++) = column;
    e.pairs.push_back(all[p]);
  }
  e.F.conservativeResize(Eigen::NoChange, columns);
  return e;
}

body::Inertia inertia(const ElementMaps& maps, const Eigen::MatrixXd& V) {
  // without mass points: a beam without density, in the plane of 6 dofs, in space of 12
  const int without = maps.bending.rows() > 6 ? 3 : 2;
  const int d = maps.mass.empty() ? without : static_cast<int>(maps.mass.front().x.size());
  body::Inertia sum(d, static_cast<int>(V.cols()));
  for (const body::MassPoint& point : maps.mass) sum.add(body::MassPoint{point.mass, point.x, point.N * V});
  for (const body::RotatingMass& mass : maps.rotary) sum.add(body::RotatingMass(mass, mass.rotation * V));
  return sum;
}

}  // namespace floe::fem
