#pragma once
#include <vector>

#include "floe/fem/structure.h"
#include "floe/reference/full_order.h"

namespace floe::reference {

/// A part of a cell's mass that one of its corners carries rigidly.
struct CarriedMass {
  int corner;
  double mass;
  Eigen::Vector3d arm;     ///< of its centre from the corner, body axes
  Eigen::Matrix3d spread;  ///< int rho y y' about that centre
};

/// Mass, first and second moments of a cell (of a unit density on its line or area), by quadrature with one point near
/// each corner, exact for second moments: two Gauss points of a line, (2/3, 1/6, 1/6) of a triangle; sections in full.
std::vector<CarriedMass> carried_mass(const fem::Structure& structure, const fem::Mesh::Cell& cell, Density density);

}  // namespace floe::reference
