#pragma once
#include "floe/fem/element.h"

namespace floe::fem {

/// Per unit length: axial and bending stiffness [N], [N m2], mass and rotary inertia [kg/m], [kg m].
struct BeamSection {
  double EA = 0, EI = 0, rhoA = 0, rhoI = 0;
};

/// How the membrane strain of a beam element is taken. `pointwise` is the paper's and locks in membrane (its cubic v
/// asks for a quartic strain that linear u cannot balance); `averaged` over the element is free of locking at every
/// slenderness.
enum class MembraneStrain { averaged, pointwise };

/// Planar Euler-Bernoulli element with von Karman strain: u linear, v cubic, dofs (u, v, rotation) at two nodes, body
/// axes.
///
///   eps = u' + 1/2 v'^2,   kappa = v'',   r(x, y) = (x + u - y v', y + v)
///
/// Mass points stand at y = +-sqrt(rhoI/rhoA), so that rotary inertia is exact; on the axis if rhoI = 0.
/// @param from, to  positions of the nodes in body axes, apart from each other
ElementMaps planar_beam(const Eigen::Vector2d& from, const Eigen::Vector2d& to, const BeamSection& section,
                        MembraneStrain strain);

/// Uniform line samples of the element (weight per length 1, on the axis): what distributed loads act on.
std::vector<body::MassPoint> planar_beam_line(const Eigen::Vector2d& from, const Eigen::Vector2d& to);

}  // namespace floe::fem
