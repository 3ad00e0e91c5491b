#include "floe/dynamics/marker_pair.h"

#include "floe/dynamics/local_indices.h"

namespace floe::dynamics {

Wrench on_second_place(const Vector6& wrench) {
  return (Wrench() << -wrench[3], -wrench[4], 0, 0, 0, -wrench[5]).finished();
}

MarkerPair::MarkerPair(Marker one, Marker other) : first(std::move(one)), second(std::move(other)) {
  where_first = place_all(first.coordinates, coordinates);
  where_second = place_all(second.coordinates, coordinates);
}

void MarkerPair::evaluate(const Motion& motion, EvaluationLevel level) {
  const auto see = [&](const Marker& marker, const std::vector<int>& where, State& state, Pose& out) {
    pick(where, motion.q, state.q);
    if (level == EvaluationLevel::velocity) pick(where, motion.v, state.v), pick(where, motion.a, state.a);
    pose(marker, state.q, state.v, state.a, out, level);
  };
  see(first, where_first, state_first, pose_first);
  see(second, where_second, state_second, pose_second);
}

Vector6 MarkerPair::y() const { return (Vector6() << pose_first.y, pose_second.y).finished(); }
Vector6 MarkerPair::yd() const { return (Vector6() << pose_first.yd, pose_second.yd).finished(); }
Vector6 MarkerPair::ydd() const { return (Vector6() << pose_first.ydd, pose_second.ydd).finished(); }

void MarkerPair::add(const Vector6& wrench, Eigen::VectorXd& r) const {
  for (std::size_t i = 0; i < where_first.size(); ++i) r[where_first[i]] += pose_first.P.col(i).dot(wrench.head<3>());
  for (std::size_t i = 0; i < where_second.size(); ++i)
    r[where_second[i]] += pose_second.P.col(i).dot(wrench.tail<3>());
}

void MarkerPair::add_rate_gradient(const Vector6& by_rates, Eigen::VectorXd& r) const {
  for (std::size_t i = 0; i < where_first.size(); ++i)
    r[where_first[i]] += pose_first.dyd.col(i).dot(by_rates.head<3>());
  for (std::size_t i = 0; i < where_second.size(); ++i)
    r[where_second[i]] += pose_second.dyd.col(i).dot(by_rates.tail<3>());
}

void MarkerPair::add_tangent(const Vector6& wrench, const Matrix6& Y, const Matrix6& Yd, Weights weights,
                             Eigen::MatrixXd& J) const {
  const Matrix6 of_y = weights.q * Y + weights.v * Yd, of_yd = weights.q * Yd;
  const bool damped = !of_yd.isZero(0), depends = damped || !of_y.isZero(0);
  const Pose* poses[2] = {&pose_first, &pose_second};
  const std::vector<int>* where[2] = {&where_first, &where_second};
  for (int j = 0; depends && j < 2; ++j)
    for (std::size_t column = 0; column < where[j]->size(); ++column) {
      Vector6 change = of_y.middleCols<3>(3 * j) * poses[j]->P.col(column);
      if (damped) change += of_yd.middleCols<3>(3 * j) * poses[j]->dyd.col(column);
      for (int i = 0; i < 2; ++i)
        for (std::size_t row = 0; row < where[i]->size(); ++row)
          J((*where[i])[row], (*where[j])[column]) += poses[i]->P.col(row).dot(change.segment<3>(3 * i));
    }
  for (int i = 0; i < 2; ++i) {
    if (!(i == 0 ? first : second).framed) continue;
    const int angle = (*where[i])[2];
    for (std::size_t row = 2; row < where[i]->size(); ++row) {
      const double entry = weights.q * geometric_stiffness(*poses[i], wrench.segment<3>(3 * i), row);
      J((*where[i])[row], angle) += entry;
      if (row != 2) J(angle, (*where[i])[row]) += entry;
    }
  }
}

}  // namespace floe::dynamics
