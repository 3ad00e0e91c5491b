#pragma once
#include <Eigen/Dense>
#include <vector>

#include "floe/fem/strains.h"

namespace floe::fem {

/// Orthotropic plane-stress material: moduli [Pa], density [kg/m3]; axis 1 is the one that a ply's angle rotates.
struct ShellMaterial {
  double E1, E2, nu12, G12, density;
};

/// E1 = E2 = E, G12 = E / (2 + 2 nu).
ShellMaterial isotropic(double E, double nu, double density);

/// A layer of a laminate.
struct Ply {
  ShellMaterial material;
  double thickness;  ///< [m]
  double angle = 0;  ///< from the section's axis to the material's axis 1, right-handed about the normal [rad]
};

/// A thin shell's stiffness and mass per area, referred to the plane of its nodes (z = 0, along the normal).
///
///   (N, M) = [A B; B D] (eps, kappa),   eps(z) = eps + z kappa,   kappa = -(w_xx, w_yy, 2 w_xy)
///
/// kept as the sum of squares that the elements use,
///
///   2 U = (eps + C kappa)' A (eps + C kappa) + kappa' D* kappa,   C = A^-1 B,   D* = D - B A^-1 B.
///
/// `shear` is 5/6 sum G12 h of the layers (G13 = G23 = G12).
///
/// D* and the radius of inertia do not depend on the plane of reference, so that no digits cancel for a thin shell far
/// from it.
struct ShellSection {
  Eigen::Matrix3d A;         ///< membrane [N/m]
  Eigen::Matrix3d coupling;  ///< C [m]
  Eigen::Matrix3d bending;   ///< D* [N m]
  double shear;              ///< transverse, of both directions [N/m]; elements of second order alone shear
  double higher_order;       ///< beta_0 of the membrane triangle
  double drilling = 1.5;     ///< alpha of the membrane triangle
  double mass;               ///< [kg/m2]
  double mass_centre;        ///< its height above the plane of the nodes [m]
  double mass_radius;        ///< radius of inertia about that centre [m]
  Eigen::Vector3d axis;      ///< projected on an element it is the axis of angle 0; zero: isotropic, any axis
  Strains strains = Strains::von_karman;

  Eigen::Matrix3d B() const { return A * coupling; }                                   ///< [N]
  Eigen::Matrix3d D() const { return bending + coupling.transpose() * A * coupling; }  ///< [N m]
  double first_moment() const { return mass * mass_centre; }                           ///< int rho z dz [kg/m]
  double rotary_inertia() const {                                                      ///< int rho z^2 dz [kg]
    return mass * (mass_centre * mass_centre + mass_radius * mass_radius);
  }
};

/// Classical lamination theory of a stack.
///
/// @param plies   from the lowest z to the highest
/// @param offset  height of the stack's middle above the plane of the nodes [m]
/// @param axis    direction in body axes, any length; needed unless all plies are isotropic
/// @throws InputError  no ply, a thickness or modulus not positive, nu12^2 >= E1 / E2, no axis
/// Source: Jones, Mechanics of composite materials, ch. 4; beta_0: Felippa 2003 (isotropic: (1 - 4 nu^2) / 2).
ShellSection shell_section(const std::vector<Ply>& plies, double offset = 0,
                           const Eigen::Vector3d& axis = Eigen::Vector3d::Zero());

/// A section by its stiffness about the plane of the nodes, (N, M) = [A B; B D] (eps, kappa), and its mass per area.
///
/// The mass is centred in that plane. Its radius of inertia is that of a homogeneous shell of this stiffness,
/// r^2 = (D*_11 + D*_22) / (A_11 + A_22). `shear` is 5/6 A_33, as of a homogeneous shell with G13 = G23 = G12.
/// @param A, B, D  symmetric; together positive definite
/// @param mass     [kg/m2]
/// @param axis     direction of eps_11, as of shell_section; without effect where all directions have one stiffness
/// @throws InputError  not positive definite; a mass that is negative; no axis where the directions differ
ShellSection stiffness_section(const Eigen::Matrix3d& A, const Eigen::Matrix3d& B, const Eigen::Matrix3d& D,
                               double mass, const Eigen::Vector3d& axis = Eigen::Vector3d::Zero());

/// The section of a flat element with three or four nodes on a surface that is curved (Mesh::Cell::rise s):
///
///   eta beta_0,   min(3/2 eta^(1/12), 50 eta^(1/2)) for alpha,   eta = 1 / (1 + (10 s / t)^2),   t^2 = 12 tr D* / tr A
///
/// Bending of the surface without stretching rotates nodes about axes in it, not in the planes of the elements:
/// drilling rotations of their corners differ by kappa h, times the slope 4 s / h. By beta_0 that costs (s / t)^2 times
/// the energy of bending: elements lock. With eta at most about a hundredth remains. alpha follows so that strips of
/// elements up to twice as long as wide have 0.65 to 1.46 of their deflection in their plane with one across (with 3/2
/// twice it at s = 3 t, with eta^(1/12) alone 8 times at 100 t), 0.69 to 1 with two, 0.79 to 1 with four. Flat elements
/// keep beta_0 and 3/2; small rises change them little.
ShellSection on_curved_surface(ShellSection section, double rise);

/// Plane-stress stiffness Q of a material in its own axes, (1, 2, 12) [Pa].
Eigen::Matrix3d plane_stress(const ShellMaterial& material);

}  // namespace floe::fem
