#pragma once
#include "floe/reduction/projection.h"

namespace floe::reduction {

/// A node in the mean of a place: x += weight x_node, u += weight u_node + arm theta_node,
/// theta += (weight + twist) theta_node + turn u_node; where it follows another at an arm, u_node to second order in u
/// (fem::RigidArm).
struct WeightedNode {
  PetscInt node;                                    ///< global
  double weight;                                    ///< their sum is 1
  Eigen::Matrix3d arm = Eigen::Matrix3d::Zero();    ///< in space; their sum is 0
  Eigen::Matrix3d turn = Eigen::Matrix3d::Zero();   ///< in space; their sum is 0 [1/m]
  Eigen::Matrix3d twist = Eigen::Matrix3d::Zero();  ///< in space
};

/// The weighted mean over nodes of position, displacement and rotation: how a set of nodes moves as one place.
/// Collective; replicated.
/// @param nodes  at least one, the same on all ranks
body::PlaceMap place_map(const fem::Structure& structure, const Basis& basis, const std::vector<WeightedNode>& nodes);

}  // namespace floe::reduction
