#pragma once
#include <vector>

#include "floe/dynamics/spatial_marker.h"
#include "floe/dynamics/term.h"

namespace floe::reference {

/// Several places in space that one term acts on: as dynamics::SpatialPair, of any number. Wrenches in world axes, 6
/// for each place, become rows of the places' coordinates.
class SpatialPlaces {
 public:
  explicit SpatialPlaces(std::vector<dynamics::SpatialMarker> markers);

  const std::vector<int>& coordinates() const { return coordinates_; }
  Eigen::Index size() const { return static_cast<Eigen::Index>(pose_.size()); }
  const dynamics::SpatialPose& operator[](Eigen::Index i) const { return pose_[i]; }
  /// Poses at a motion; add() needs places, add_tangent() directions, with Yd the motion.
  void see(const dynamics::Motion& motion, dynamics::EvaluationLevel level);
  /// r += P' wrenches. @param wrenches  6n
  void add(const Eigen::VectorXd& wrenches, Eigen::VectorXd& r);
  /// J += derivative of add(wrenches, r).
  /// @param Y   change of the wrenches with virtual motions (dp, dphi) at fixed velocities and spins, 6n x 6n
  /// @param Yd  with velocities and spins; null: none
  void add_tangent(const Eigen::VectorXd& wrenches, const Eigen::MatrixXd& Y, const Eigen::MatrixXd* Yd,
                   dynamics::Weights weights, Eigen::MatrixXd& J);

 private:
  std::vector<dynamics::SpatialMarker> marker_;
  std::vector<std::vector<int>> where_;
  std::vector<dynamics::SpatialPose> pose_;
  std::vector<int> coordinates_;
  Eigen::VectorXd q_, v_, a_, rows_;
  Eigen::MatrixXd change_, block_;
  dynamics::Matrix6Xd rates_;
};

}  // namespace floe::reference
