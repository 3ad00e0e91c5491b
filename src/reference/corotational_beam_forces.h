#pragma once
#include "corotational_beam_chord.h"
#include "floe/reference/corotational_beam.h"

// Forces and energies of the corotational beam over its extended coordinates z (corotational_beam_chord.h).
namespace floe::reference::corotational {

/// Integrals over an undeformed element of length l0, in closed form. Without shear phi_1 = l0 xi (1-xi)^2, phi_2 = -l0
/// xi^2 (1-xi); with shear those that T = 1 - c [1 1; 1 1] makes of them. alpha_i = phi_i' + c: rotation of the
/// section.
struct Moments {
  double mass;                    ///< int rhoA
  Eigen::Vector2d first, last;    ///< int rhoA (1 - xi) phi_i,  int rhoA xi phi_i
  Eigen::Matrix2d deflection;     ///< int rhoA phi_i phi_j
  double rotary;                  ///< int rhoI
  Eigen::Matrix2d slope;          ///< 1/l0 int phi_i' phi_j'
  Eigen::Matrix2d rotation;       ///< 1/l0 int alpha_i alpha_j
  Eigen::Vector2d mean_rotation;  ///< 1/l0 int alpha_i = c; zero without shear
  double axial;                   ///< EA / l0
  Eigen::Matrix2d bending;        ///< int EI phi_i'' phi_j'' + GA c^2
};
Moments moments(double length, const CorotationalBeam::Properties& properties);

/// eps - the membrane strain, averaged over the element.
double membrane_strain(const Moments& m, double length, const Chord& chord);
double elastic_energy(const Moments& m, double length, const Chord& chord);
Seven elastic_force(const Moments& m, double length, const Chord& chord);
SevenSquare elastic_stiffness(const Moments& m, double length, const Chord& chord);

/// EA l0 (deps/dz)' eps. + (0, B a.) for one unit of viscosity, and its derivatives times `weight`.
Seven viscous_force(const Moments& m, double length, const Chord& chord, const Seven& velocity);
struct ForceTangent;
void add_viscous_tangent(const Moments& m, double length, const Chord& chord, const Seven& velocity, double weight,
                         ForceTangent& by);

double kinetic_energy(const Moments& m, const Chord& chord, const Seven& velocity);

/// int rhoA (dr/dz)' r.. + rhoI (dpsi/dz)' psi.., psi the rotation of the section.
///
/// Gravity g is the same as accelerations of the nodes less g.
Seven inertia_force(const Moments& m, const Chord& chord, const Rates& rates);

/// Derivatives of a force with respect to z, z., z...
struct ForceTangent {
  SevenSquare K, C, M;
};
ForceTangent inertia_tangent(const Moments& m, const Chord& chord, const Rates& rates);

}  // namespace floe::reference::corotational
