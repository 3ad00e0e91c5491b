#pragma once
#include <vector>

#include "floe/fem/structure.h"

namespace floe::plan {

/// One side of a node of a beam: an element that begins or ends there, and what of the body hangs on it.
struct BeamSide {
  bool after = false;   ///< the element begins there: it lies towards increasing x
  bool middle = false;  ///< the node is the middle one of an element of second order: no side, but the element itself
  Eigen::Matrix3d axes = Eigen::Matrix3d::Zero();  ///< of the section there: x, y, z as columns in the body's axes
  Eigen::Vector3d away = Eigen::Vector3d::Zero();  ///< from the node along the element
  int cell = -1;                                   ///< among this rank's; -1: another rank has it
  PetscInt by = 0;                                 ///< global: the node that moves this one
  bool separates = true;                           ///< what hangs on the element hangs on nothing else
  std::vector<char> cells;                         ///< of this rank's: whether they belong to it
  std::vector<char> nodes;  ///< of all, global: whether they move places of it, and of nothing else
};

/// The sides of a node: one for each beam element that begins or ends there, in the order of the elements' ranks.
/// Collective; the same on all ranks but for `cell` and `cells`.
std::vector<BeamSide> beam_sides(const fem::Structure& structure, PetscInt node);

}  // namespace floe::plan
