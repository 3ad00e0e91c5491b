#include "floe/dynamics/marker_pair.h"

#include <algorithm>

namespace floe::dynamics {
namespace {

std::vector<int> place_all(const std::vector<int>& indices, std::vector<int>& all) {
  std::vector<int> where;
  for (int index : indices) {
    const auto found = std::find(all.begin(), all.end(), index);
    where.push_back(static_cast<int>(found - all.begin()));
    if (found == all.end()) all.push_back(index);
  }
  return where;
}

void pick(const std::vector<int>& where, const Eigen::VectorXd& from, Eigen::VectorXd& to) {
  to.resize(static_cast<Eigen::Index>(where.size()));
  for (std::size_t i = 0; i < where.size(); ++i) to[i] = from[where[i]];
}

void scatter(const std::vector<int>& rows, const std::vector<int>& columns, const Eigen::MatrixXd& block,
             Eigen::MatrixXd& J) {
  for (std::size_t j = 0; j < columns.size(); ++j)
    for (std::size_t i = 0; i < rows.size(); ++i) J(rows[i], columns[j]) += block(i, j);
}

}  // namespace

MarkerPair::MarkerPair(Marker one, Marker other) : first(std::move(one)), second(std::move(other)) {
  where_first = place_all(first.coordinates, coordinates);
  where_second = place_all(second.coordinates, coordinates);
}

void MarkerPair::evaluate(const Motion& motion) {
  pick(where_first, motion.q, q), pick(where_first, motion.v, v), pick(where_first, motion.a, a);
  pose(first, q, v, a, pose_first);
  pick(where_second, motion.q, q), pick(where_second, motion.v, v), pick(where_second, motion.a, a);
  pose(second, q, v, a, pose_second);
}

Vector6 MarkerPair::y() const { return (Vector6() << pose_first.y, pose_second.y).finished(); }
Vector6 MarkerPair::yd() const { return (Vector6() << pose_first.yd, pose_second.yd).finished(); }
Vector6 MarkerPair::ydd() const { return (Vector6() << pose_first.ydd, pose_second.ydd).finished(); }

void MarkerPair::add(const Vector6& wrench, Eigen::VectorXd& r) const {
  for (std::size_t i = 0; i < where_first.size(); ++i) r[where_first[i]] += pose_first.P.col(i).dot(wrench.head<3>());
  for (std::size_t i = 0; i < where_second.size(); ++i)
    r[where_second[i]] += pose_second.P.col(i).dot(wrench.tail<3>());
}

void MarkerPair::add_tangent(const Vector6& wrench, const Matrix6& Y, const Matrix6& Yd, Weights weights,
                             Eigen::MatrixXd& J) const {
  const Matrix6 total = weights.q * Y + weights.v * Yd;
  const Marker* markers[2] = {&first, &second};
  const Pose* poses[2] = {&pose_first, &pose_second};
  const std::vector<int>* where[2] = {&where_first, &where_second};
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 2; ++j) {
      const Eigen::MatrixXd block =
          poses[i]->P.transpose() *
          (total.block<3, 3>(3 * i, 3 * j) * poses[j]->P + weights.q * Yd.block<3, 3>(3 * i, 3 * j) * poses[j]->dyd);
      scatter(*where[i], *where[j], block, J);
    }
    const Eigen::Index n = static_cast<Eigen::Index>(where[i]->size());
    Eigen::MatrixXd geometric = Eigen::MatrixXd::Zero(n, n);
    add_geometric_stiffness(*markers[i], *poses[i], wrench.segment<3>(3 * i), weights.q, geometric);
    scatter(*where[i], *where[i], geometric, J);
  }
}

}  // namespace floe::dynamics
