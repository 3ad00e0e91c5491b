#include "floe/dynamics/spatial_pair.h"

#include "floe/dynamics/local_indices.h"

namespace floe::dynamics {

using Eigen::Index;

SpatialPair::SpatialPair(SpatialMarker first, SpatialMarker second) : marker{std::move(first), std::move(second)} {
  for (int i = 0; i < 2; ++i) where[i] = place_all(marker[i].coordinates, coordinates);
}

void SpatialPair::evaluate(const Motion& motion, EvaluationLevel level) {
  for (int i = 0; i < 2; ++i) {
    auto& [q, v, a] = state_[i];
    pick(where[i], motion.q, q);
    if (level == EvaluationLevel::velocity) pick(where[i], motion.v, v), pick(where[i], motion.a, a);
    dynamics::pose(marker[i], q, v, a, pose[i], level);
  }
}

void SpatialPair::add(const Vector12& wrench, Eigen::VectorXd& r) {
  for (int i = 0; i < 2; ++i) {
    if (where[i].empty()) continue;
    pull_back(marker[i], pose[i], wrench.segment<6>(6 * i), rows_);
    for (std::size_t row = 0; row < where[i].size(); ++row) r[where[i][row]] += rows_[row];
  }
}

void SpatialPair::add_gradient(const Vector12& gradient, Eigen::VectorXd& r) {
  for (int i = 0; i < 2; ++i) {
    if (where[i].empty()) continue;
    pull_back(marker[i], pose[i], gradient.segment<6>(6 * i), rows_);
    if (marker[i].framed()) rows_.segment<3>(3) = (pose[i].T.transpose() * rows_.segment<3>(3)).eval();
    for (std::size_t row = 0; row < where[i].size(); ++row) r[where[i][row]] += rows_[row];
  }
}

void SpatialPair::add_rate_gradient(const Vector12& by_rates, Eigen::VectorXd& r) {
  for (int i = 0; i < 2; ++i) {
    if (where[i].empty()) continue;
    rate_gradient(marker[i], pose[i], rates_[i]);
    rows_.noalias() = rates_[i].transpose() * by_rates.segment<6>(6 * i);
    if (marker[i].framed()) rows_.segment<3>(3) = (pose[i].T.transpose() * rows_.segment<3>(3)).eval();
    for (std::size_t row = 0; row < where[i].size(); ++row) r[where[i][row]] += rows_[row];
  }
}

void SpatialPair::differentiate(const Matrix12& Y, const Matrix12& Yd, bool damped, Weights weights, int j) {
  using Half = Eigen::Matrix<double, 12, 6>;
  const Half of_place = weights.q * Y.middleCols<6>(6 * j), of_rates = Yd.middleCols<6>(6 * j);
  auto& change = change_[j];
  change.noalias() = of_place * pose[j].P;
  if (damped) {
    const Half by_place = weights.q * of_rates;
    rate_gradient(marker[j], pose[j], rates_[j]);
    change.noalias() += by_place * rates_[j];
  }
  if (marker[j].framed()) change.middleCols<3>(3) = (change.middleCols<3>(3) * pose[j].T).eval();
  if (damped && weights.v != 0) {
    const Half by_rates = weights.v * of_rates;
    change.noalias() += by_rates * pose[j].P;
  }
}

void SpatialPair::add_tangent(const Vector12& wrench, const Matrix12& Y, const Matrix12& Yd, Weights weights,
                              Eigen::MatrixXd& J) {
  const bool damped = !Yd.isZero(0), depends = damped || !Y.isZero(0);
  for (int j = 0; j < 2; ++j) {
    if (where[j].empty()) continue;
    if (depends) differentiate(Y, Yd, damped, weights, j);
    for (int i = 0; i < 2; ++i) {
      if (where[i].empty() || (i != j && !depends)) continue;
      Eigen::MatrixXd& block = block_[i][j];
      const Index rows = static_cast<Index>(where[i].size()), columns = static_cast<Index>(where[j].size());
      if (depends)
        block.noalias() = pose[i].P.transpose() * change_[j].middleRows<6>(6 * i);
      else
        block.setZero(rows, columns);
      if (i == j) add_geometric_stiffness(marker[i], pose[i], wrench.segment<6>(6 * i), weights.q, block);
      for (Index column = 0; column < columns; ++column)
        for (Index row = 0; row < rows; ++row) J(where[i][row], where[j][column]) += block(row, column);
    }
  }
}

}  // namespace floe::dynamics
