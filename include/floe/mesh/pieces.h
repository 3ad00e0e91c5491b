#pragma once
#include <string>

#include "floe/mesh/links.h"

namespace floe::mesh {

/// Links with pieces besides: sets of nodes that move as one rigid body each. Sets and links with a node in common are
/// one piece; it is led by the reference of its link, if it has one, else by the node in the middle of its numbers.
///
/// @param links   as mesh::dependent_nodes gives them; nodes of those that leave rotations free are in no piece
/// @return        ascending by node
/// Rank-local.
std::vector<DependentNode> with_pieces(const std::vector<DependentNode>& links,
                                       const std::vector<std::vector<PetscInt>>& pieces);

/// A straight line hinge: its nodes move as those of a rigid line, and each rotates about it by itself.
struct HingeLine {
  std::vector<PetscInt> nodes;
  std::array<double, 3> axis{};  ///< along the line, unit vector
  std::string where = {};        ///< for messages: the joint
  bool constrained = false;      ///< by the ground: may be left out, for its nodes can be constrained one by one
  std::string holder = {};       ///< what the joint connects the line to: a body, or the ground
};

/// Dependent nodes with line hinges besides. A line is led by the piece or link that it has a node in common with, else
/// by the node that it shares with the line of another holder, else by its first one among `preferred`, else by the
/// node in the middle of its numbers. Lines with two nodes in common, and parallel ones of one holder that meet, are
/// one.
///
/// Lines of one holder that meet at an angle are one rigid rim: their pins are fixed to that holder and hence to one
/// another. One node leads them, a corner where no piece does; a node where lines cross has no rotation of its own, as
/// the slopes along both edges are those of the rim.
///
/// Where a line or rim would have two independent nodes, or a rim meets the line of another holder, those that the
/// ground holds are left out if they touch another one.
///
/// @param dependent_nodes  as with_pieces gives them
/// @param preferred  nodes that something else holds, which an independent node can be and a dependent node cannot
/// @param left_out   receives `where` of lines that are left out
/// @return           ascending by node
/// @throws InputError  a line that two others would lead even so
/// Rank-local.
std::vector<DependentNode> with_lines(const std::vector<DependentNode>& dependent_nodes, std::vector<HingeLine> lines,
                                      const std::vector<PetscInt>& preferred = {},
                                      std::vector<std::string>* left_out = nullptr);

}  // namespace floe::mesh
