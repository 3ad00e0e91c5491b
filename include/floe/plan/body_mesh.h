#pragma once
#include <vector>

#include "floe/fem/mesh.h"
#include "floe/output/reduced_file.h"

namespace floe::plan {

/// A body's mesh, for results: this rank's share.
struct BodyMesh {
  output::ReducedShapes shapes;  ///< without basis vectors; positions in the axes of the floating frame
  std::vector<fem::Mesh::DependentNode> dependent_nodes;  ///< owned nodes that move rigidly with others, local numbers
  std::vector<fem::Mesh::Spin> spins = {};                ///< those of them with rotations of their own

  /// Numbers of each owned node, dofs_per_node each, made those of the node as it moves: dependent nodes take over the
  /// motion of those that they follow, u + theta x arm, theta but for rotations of their own.
  void let_follow(std::span<double> values) const;
  /// From the node that moves it; zero where it moves by itself.
  Eigen::Vector3d arm(std::size_t node) const;
  /// Whether a node has rotations of its own beside those of the one that it follows.
  bool rotates_apart(std::size_t node) const;
  /// The owned node that moves it: itself, or the one that it follows.
  std::size_t mover(std::size_t node) const;
};

}  // namespace floe::plan
