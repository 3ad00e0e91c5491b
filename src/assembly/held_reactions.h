#pragma once
#include <memory>
#include <vector>

#include "floe/dynamics/connection.h"
#include "floe/dynamics/spatial_marker.h"

namespace floe::assembly {

/// What a joint exerts by dofs of a body with a fixed frame that it holds and that have no equations: the work that the
/// body's equations lack when its place moves and rotates,
///
///   R_c = W_c' (M q.. + dU/dq - f),   c = x, y, z of its place, and rotations about it
///
/// In formulation cfr it is the sum over nodes. At full order W_c moves the held nodes alone. On reduced coordinates it
/// is their static displacement field (static constraint modes, Craig and Bampton 1968), so that the fields of all
/// joints together are rigid motions and all reactions together balance loads and inertia.
struct HeldReaction {
  /// Rows of this rank: of the body with the fields among its coordinates, which are zero, behind those of the system.
  std::vector<std::shared_ptr<const dynamics::Term>> terms;
  /// Another joint of the body, and where it acts among the rows. On the last rank.
  struct Acting {
    std::vector<const dynamics::Connection*> connections;
    int side = 1;  ///< of its places the body's
    dynamics::SpatialMarker first, second, on_body;
  };
  std::vector<Acting> others;
  /// Of a joint that holds single nodes: their rows, its own or those of another joint, which act on the node.
  struct OnNode {
    const dynamics::Connection* connection;
    dynamics::SpatialMarker node;
    double share = 1;  ///< of the joint, where several hold the node
  };
  std::vector<OnNode> nodes;
  dynamics::SpatialMarker place;  ///< about which, likewise
  /// What a row counts in the wrench about the place, frame axes.
  struct Row {
    int coordinate;
    dynamics::Wrench wrench;
  };
  std::vector<Row> rows;
  int coordinates = 0;                                 ///< those of the system and those behind them
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< of the frame, in the world
  double sign = 1;                                     ///< -1: the joint's second place is on the ground
};

/// The share of this rank in what the joint exerts on its second place, about this, world axes.
/// @param q, v, a  local coordinates and rates of the system
dynamics::Wrench held_by(const HeldReaction& reaction, double t, const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                         const Eigen::VectorXd& a);

}  // namespace floe::assembly
