#pragma once
#include "floe/fem/structure.h"

namespace floe::fem {

/// Whether the sections belong on the cells that have them. The fault that is reported is the one of the cell whose
/// first corner comes first (by x, then y, then z): the same on any number of ranks. Collective.
/// @throws InputError  a section does not belong on a cell of this kind, or its axes do not
void check_cells(const Structure& structure);

/// Of the rotations of rigid links those that count in von Karman's strains of a shell: 1 - n n', n its normal at its
/// corners' places x. Such strains know slopes alone: an edge that a rigid link holds contracts by 1/2 theta x (theta x
/// arm), as w_y^2 / 2 requires where it rotates about its normal in the plane; rotations about n are of first order.
Eigen::Matrix3d slopes_of_arms(const Mesh::Cell& cell, const std::vector<Eigen::Vector3d>& x);

}  // namespace floe::fem
