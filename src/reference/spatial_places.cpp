#include "floe/reference/spatial_places.h"

#include "floe/dynamics/local_indices.h"

namespace floe::reference {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

SpatialPlaces::SpatialPlaces(std::vector<dynamics::SpatialMarker> markers)
    : marker_(std::move(markers)), pose_(marker_.size()) {
  for (const dynamics::SpatialMarker& at : marker_) where_.push_back(dynamics::place_all(at.coordinates, coordinates_));
}

void SpatialPlaces::see(const dynamics::Motion& motion, dynamics::EvaluationLevel level) {
  for (std::size_t i = 0; i < marker_.size(); ++i) {
    dynamics::pick(where_[i], motion.q, q_);
    if (level == dynamics::EvaluationLevel::velocity)
      dynamics::pick(where_[i], motion.v, v_), dynamics::pick(where_[i], motion.a, a_);
    dynamics::pose(marker_[i], q_, v_, a_, pose_[i], level);
  }
}

void SpatialPlaces::add(const VectorXd& wrenches, VectorXd& r) {
  for (std::size_t i = 0; i < marker_.size(); ++i) {
    pull_back(marker_[i], pose_[i], wrenches.segment<6>(6 * static_cast<Index>(i)), rows_);
    for (std::size_t row = 0; row < where_[i].size(); ++row) r[where_[i][row]] += rows_[static_cast<Index>(row)];
  }
}

void SpatialPlaces::add_tangent(const VectorXd& wrenches, const MatrixXd& Y, const MatrixXd* Yd,
                                dynamics::Weights weights, MatrixXd& J) {
  for (std::size_t j = 0; j < marker_.size(); ++j) {
    const Index from = 6 * static_cast<Index>(j);
    change_.noalias() = weights.q * Y.middleCols<6>(from) * pose_[j].P;
    if (Yd) {
      rate_gradient(marker_[j], pose_[j], rates_);
      change_.noalias() += weights.q * Yd->middleCols<6>(from) * rates_;
    }
    if (marker_[j].framed()) change_.middleCols<3>(3) = (change_.middleCols<3>(3) * pose_[j].T).eval();
    if (Yd && weights.v != 0) change_.noalias() += weights.v * Yd->middleCols<6>(from) * pose_[j].P;
    for (std::size_t i = 0; i < marker_.size(); ++i) {
      const Index to = 6 * static_cast<Index>(i);
      block_.noalias() = pose_[i].P.transpose() * change_.middleRows<6>(to);
      if (i == j) add_geometric_stiffness(marker_[i], pose_[i], wrenches.segment<6>(to), weights.q, block_);
      for (Index column = 0; column < block_.cols(); ++column)
        for (Index row = 0; row < block_.rows(); ++row) J(where_[i][row], where_[j][column]) += block_(row, column);
    }
  }
}

}  // namespace floe::reference
