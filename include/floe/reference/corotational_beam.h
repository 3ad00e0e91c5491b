#pragma once
#include <Eigen/Dense>
#include <functional>
#include <limits>
#include <vector>

#include "floe/dynamics/term.h"

namespace floe::reference {

/// Planar corotational beam element, Bernoulli's or Timoshenko's where GA is finite, with cubic deflection in the
/// internal force and in the inertia.
///
/// Coordinates q = (u1, v1, theta1, u2, v2, theta2): displacements [m] and rotations [rad, unwrapped] of the two nodes
/// from the undeformed configuration, world axes. The chord from node 1 to node 2 has length l, direction e, normal n
/// and has rotated by beta; the local rotations are a_i = theta_i - beta, beta taken next to (theta1 + theta2)/2 by
/// whole turns. With xi = x/l0 and the deflection w = phi_1 a_1 + phi_2 a_2 from the chord, by clamped cubics,
///     r(x) = (1 - xi) r1 + xi r2 + n w,    rotation of the section = beta + w'
///     T = 1/2 int rhoA |dr/dt|^2 + rhoI (dbeta/dt + dw'/dt)^2 dx
///     U = 1/2 EA l0 eps^2 + 1/2 EI int w''^2 dx,    eps = (l - l0)/l0 + 1/(2 l0) int w'^2 dx
///     V = - int rhoA g.r dx,    D = 1/2 beta (EA l0 (deps/dt)^2 + EI int (dw''/dt)^2 dx)
///
/// With shear the section rotates by alpha = w' - gamma against the chord and a_i are its values at the ends; gamma is
/// constant, from the equilibrium without load between the ends:
///     gamma = -c (a_1 + a_2),   c = Phi / (2 (1 + Phi)),   Phi = 12 EI / (GA l0^2)
///     w = phi_1 (a_1 + gamma) + phi_2 (a_2 + gamma),   U has + 1/2 GA l0 gamma^2,   T has rhoI (dbeta/dt +
///     dalpha/dt)^2,
/// and eps keeps w', the slope of the line.
///
/// Kelvin-Voigt damping D acts on the strain rates: a rigid motion has none.
///
/// Nothing of T is neglected: the force holds every gyroscopic and centrifugal term, and the tangent is exact. The
/// element itself is that of small local rotations (section rotation w' for atan w', x for the arc length), which mesh
/// refinement removes. Observed orders in l0: 4 in statics under end loads and in bending frequencies, 2 in axial
/// inertia and so in transients.
///
/// A chord that shrinks to a point gives values that are not finite.
///
/// Source: Le, Battini, Hjiaj 2011, Comput. Mech. 48; here with every power of a_i in the inertia.
/// Shear: Reissner 1972, J. Appl. Math. Phys. 23; Przemieniecki 1968, Theory of Matrix Structural Analysis, sec. 5.6.
class CorotationalBeam : public dynamics::Term {
 public:
  /// Per unit length: axial [N] and bending stiffness [N m2], mass [kg/m], rotary inertia [kg m] (0: left out);
  /// beta of Kelvin-Voigt damping [s]; shear stiffness kappa G A [N], infinite: Euler-Bernoulli.
  struct Properties {
    double EA, EI, rhoA, rhoI, viscosity = 0, GA = std::numeric_limits<double>::infinity();
  };

  /// @param coordinates  six different indices into the system's local coordinates, in the order of q
  /// @param X1, X2       the nodes at zero displacement, world axes [m]
  /// @param gravity      acceleration of free fall, world axes [m/s2]
  /// @throws InputError  nodes that coincide, EA, EI, GA or rhoA not positive, rhoI negative, a number that is not
  /// finite
  CorotationalBeam(std::vector<int> coordinates, Eigen::Vector2d X1, Eigen::Vector2d X2, Properties properties,
                   Eigen::Vector2d gravity = Eigen::Vector2d::Zero());

  const std::vector<int>& coordinates() const override { return coordinates_; }
  void residual(const dynamics::Motion& motion, Eigen::VectorXd& r) const override;
  void tangent(const dynamics::Motion& motion, dynamics::Weights weights, Eigen::MatrixXd& J) const override;
  dynamics::Energy energy(const dynamics::Motion& motion) const override;
  double strain_damping() const override { return properties_.viscosity; }
  /// Gravity that changes with time, added to the other one; it has no potential. Empty: none.
  std::function<Eigen::Vector2d(double)> changing_gravity;

 private:
  Eigen::Vector2d gravity(double t) const;
  std::vector<int> coordinates_;
  Eigen::Vector2d X1_, chord_;  // undeformed
  double length_;               // undeformed
  Properties properties_;
  Eigen::Vector2d gravity_;
};

/// M(q) a of a CorotationalBeam: its inertia where nothing has a velocity.
class CorotationalBeamMass final : public dynamics::Term {
 public:
  /// As CorotationalBeam.
  CorotationalBeamMass(std::vector<int> coordinates, const Eigen::Vector2d& X1, const Eigen::Vector2d& X2,
                       const CorotationalBeam::Properties& properties)
      : coordinates_(std::move(coordinates)), chord_(X2 - X1), properties_(properties) {}
  const std::vector<int>& coordinates() const override { return coordinates_; }
  void residual(const dynamics::Motion& motion, Eigen::VectorXd& r) const override;
  void tangent(const dynamics::Motion& motion, dynamics::Weights weights, Eigen::MatrixXd& J) const override;

 private:
  std::vector<int> coordinates_;
  Eigen::Vector2d chord_;
  CorotationalBeam::Properties properties_;
};

}  // namespace floe::reference
