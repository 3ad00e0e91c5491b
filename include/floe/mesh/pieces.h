#pragma once
#include <string>

#include "floe/mesh/links.h"

namespace floe::mesh {

/// Links with pieces besides: sets of nodes that move as one rigid body each. Sets and links with a node in common are
/// one piece; it is led by the reference of its link, if it has one, else by the node in the middle of its numbers.
///
/// @param links   as mesh::followers gives them
/// @return        ascending by node
/// Rank-local.
std::vector<Follower> with_pieces(const std::vector<Follower>& links, const std::vector<std::vector<PetscInt>>& pieces);

/// A straight hinge line: its nodes move as those of a rigid line, and each turns about it by itself.
struct HingeLine {
  std::vector<PetscInt> nodes;
  std::array<double, 3> axis{};  ///< along the line, unit vector
  std::string where = {};        ///< for messages: the joint
  bool held = false;             ///< by the ground: may be left out, for its nodes can be held one by one
};

/// Followers with hinge lines besides. A line is led by the piece or link that it has a node in common with, else by
/// the node that it shares with another line, else by its first one among `preferred`, else by the node in the middle
/// of its numbers; lines with two nodes in common are one. Lines that the ground holds and that meet at an angle are
/// left out: both would be one rigid piece, which two hinges hold but to second order in its turn. Where a line would
/// have two leaders, those that the ground holds are left out if they touch another one.
///
/// @param followers  as with_pieces gives them
/// @param preferred  nodes that something else holds, which a leader can be and a follower cannot
/// @param left_out   receives `where` of lines that are left out
/// @return           ascending by node
/// @throws InputError  a line that two others would lead even so
/// Rank-local.
std::vector<Follower> with_lines(const std::vector<Follower>& followers, std::vector<HingeLine> lines,
                                 const std::vector<PetscInt>& preferred = {},
                                 std::vector<std::string>* left_out = nullptr);

}  // namespace floe::mesh
