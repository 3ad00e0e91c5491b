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

/// Mass, first and second moments of a cell (of a unit density on its line or area), exact to second moments, by one
/// part near each corner: two Gauss points of a line; of a triangle the third at (11/18, 7/36, 7/36), the centroid of
/// what is nearest to the corner, and 11/144 of the second moments in equal shares (a corner of one triangle alone
/// would have no inertia about that point). Sections in full.
std::vector<CarriedMass> carried_mass(const fem::Structure& structure, const fem::Mesh::Cell& cell, Density density);

}  // namespace floe::reference
