#pragma once
#include "floe/fem/structure.h"

namespace floe::fem {

/// What strains of the elements leave out, at second order, about a deformed state: S(phi) = 1/2 phi' A phi
/// of a small further deformation phi, by cause. Null: no element has it. MATSBAIJ, no conditions.
///
///   in_plane   shells with von Karman's strains, against Green-Lagrange: membrane forces N on the squares of the
///              gradients of (u, v) in the plane of each element; zero where the section has strains of second order
///                S = 1/2 int N_xx (u_x^2 + v_x^2) + N_yy (u_y^2 + v_y^2) + 2 N_xy (u_x u_y + v_x v_y)
///   coupling   spatial beams with Strains::von_karman: curvatures and twist rate of the section as it is rotated, with
///   phi its twist,
///                kappa_z = v'' + phi w'',   -kappa_y = w'' - phi v'',   tau = phi' + 1/2 (w' v'' - v' w''),
///              v' = theta_z + 1/2 phi theta_y and w' = -theta_y + 1/2 phi theta_z at the nodes; S is half the second
///              variation of 1/2 int EI kappa^2 + GJ tau^2 less that of the linear curvatures, moments being those of
///              the linear ones
///   tension    spatial beams without the Wagner term (SpatialBeamStrain::wagner): axial force N on the lengthening of
///   fibres by twist, S = 1/2 int N Ip/A phi'^2
///
/// Sources: Hodges & Dowell, NASA TN D-7818, 1974 (curvatures); theory.md.
struct MissingStiffness {
  petsc::MatHandle in_plane, coupling, tension;
};

/// @param q  deformation in the frame [m], [rad]
/// Collective. A pass over the elements for each cause.
MissingStiffness missing_stiffness(const Structure& structure, Vec q);

/// Of the strains that the elements have, the same: sum w G'(sigma P) G, sigma the membrane forces at q (without
/// conditions, MATSBAIJ). Collective.
petsc::MatHandle initial_stress_stiffness(const Structure& structure, Vec q);

}  // namespace floe::fem
