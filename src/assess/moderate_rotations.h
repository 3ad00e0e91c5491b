#pragma once
#include <Eigen/Dense>
#include <vector>

#include "floe/fem/structure.h"

namespace floe::assess {

/// A beam element in a deformed state, in the axes of its floating frame: undeformed direction e, length, bending
/// stiffness, and the rotation vectors of its ends. Nodes by numbers that do not depend on ranks.
struct BentElement {
  PetscInt node[2] = {0, 0};
  double length = 0, stiffness = 0;
  Eigen::Vector3d direction, rotation[2];
};

/// The beams of a body in a state, of all ranks and in an order that does not depend on them; none where the body has
/// shells. Collective.
std::vector<BentElement> bent_elements(const fem::Structure& structure, Vec deformation);

/// How far the tip of a line of beams is wrong, of the line's length, because von Karman's strains take slopes p
/// against the frame for rotations: with t(p) = cos|p| e + sin|p| p/|p|
///
///   places     int t(p + d) - (1 - |p|^2/2) e - p ds            (von Karman's kinematics: the last two)
///   moments    (EI d')' = (cos|p + d| - 1) M',  d(root) = 0,  EI d'(tip) = 0
///
/// The first alone is 0.04 s^3 of end moments in a tangent frame, 0.008 s^4 in a chord's. d is the rotation by which
/// the moments change when forces get the arms that they have on the deformed line (cos|p|) instead of the undeformed
/// one; M' = -t x F is taken from the state itself, so that loads, inertia and joints need not be known. Exact for
/// forces across a tangent frame; forces along the frame's chord are counted up to three times.
///
/// The root is the end with the greater moment. Where no end has one (hinges) the error is that of the shape, less the
/// rotation of its chord; without a rotation d there either.
///
/// @param parts  the line's floating frames one after another (`frames: N`), joined end to start; one may branch, then
///               every tip is looked at
/// @param degree  of the polynomial that is fitted to the moments along the line: 3 at full order, 2 for a basis, whose
///               modes make waves of a moment at an end
double rotation_error(const std::vector<std::vector<BentElement>>& parts, int degree);

}  // namespace floe::assess
