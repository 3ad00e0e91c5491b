#pragma once
#include <limits>

#include "floe/fem/element.h"

namespace floe::fem {

/// Per unit length: axial and bending stiffness [N], [N m2], mass and rotary inertia [kg/m], [kg m].
struct BeamSection {
  double EA = 0, EI = 0, rhoA = 0, rhoI = 0;
  double GA = std::numeric_limits<double>::infinity();  ///< shear stiffness kappa G A [N]; infinite: Euler-Bernoulli
};

/// How the membrane strain of a beam element is taken. `pointwise` is the paper's and locks in membrane (its cubic v
/// asks for a quartic strain that linear u cannot balance); `averaged` over the element is free of locking at every
/// slenderness.
enum class MembraneStrain { averaged, pointwise };

/// Planar beam element with von Karman strain, Euler-Bernoulli's, or Timoshenko's where GA is finite: u linear, v
/// cubic, dofs (u, v, rotation) at two nodes, body axes.
///
///   eps = u' + 1/2 v'^2,   kappa = psi',   r(x, y) = (x + u - y psi, y + v),   psi = v' - gamma
///
/// gamma is constant in the element, from its equilibrium without load, GA gamma = EI d3v/dx3:
///   (1 + Phi) gamma = Phi ((v_2 - v_1)/l - (psi_1 + psi_2)/2),   Phi = 12 EI / (GA l^2)
/// Source: Przemieniecki, Theory of matrix structural analysis, ch. 5; Friedman & Kosmatka, Comput. Struct. 47 (1993)
/// 473.
///
/// Mass points stand at y = +-sqrt(rhoI/rhoA), so that rotary inertia is exact; on the axis if rhoI = 0. They rotate
/// with the section to second order (body::RotatingMass), T = 1/2 int rhoI (theta' + psi')^2 in a frame at theta'.
/// @param from, to  positions of the nodes in body axes, apart from each other
ElementMaps planar_beam(const Eigen::Vector2d& from, const Eigen::Vector2d& to, const BeamSection& section,
                        MembraneStrain strain);

/// Uniform line samples of the element (weight per length 1, on the axis): what distributed loads act on.
/// @param section  whose shear its shapes have
std::vector<body::MassPoint> planar_beam_line(const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                                              const BeamSection& section = {});

}  // namespace floe::fem
