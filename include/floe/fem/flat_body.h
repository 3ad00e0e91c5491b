#pragma once
#include "floe/fem/structure.h"

namespace floe::fem {

/// A body of shells alone, all in one plane, whose sections do not couple membrane and bending. What moves in the plane
/// and what moves out of it have nothing in common then; in the plane's own axes all that they would share is zero to
/// the bit, whichever way the plane lies, and products of many fields leave it out.
struct FlatBody {
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< columns: two in the plane, its normal; in body axes
  std::vector<Eigen::Vector3d> positions;              ///< of local nodes in these axes, all at one height
  std::vector<Section> sections;                       ///< in these axes
};

/// The structure's, null where it is not flat (to 1e-12 of its extent); found at the first call and kept: the mesh may
/// not move after that. Collective at the first call.
const FlatBody* flat_body(const Structure& structure);

/// Of a flat body, sets the part of a field that moves in the plane or the one that moves out of it to zero where it is
/// below `share` of the other, by root mean squares, rotations times the body's extent: an iteration and the round-off
/// of K leave that, and a thin shell's membrane would answer it with stress. Likewise what moves along and across a
/// straight beam in the plane: where EA L^2 / EI is 1e10, a share of 1e-13 along a bending mode makes derivatives wrong
/// by 1e-3. Other bodies' fields stay. Collective.
void separate(const Structure& structure, Vec field, double share);

}  // namespace floe::fem
