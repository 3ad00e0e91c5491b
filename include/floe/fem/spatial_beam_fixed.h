#pragma once
#include "floe/fem/spatial_beam.h"

namespace floe::fem {

using Vector12 = Eigen::Matrix<double, 12, 1>;   ///< dofs of an element
using Matrix12 = Eigen::Matrix<double, 12, 12>;  ///< on them

/// The averaged spatial beam in arrays of fixed size: no heap is touched, for assembly in large models.
///
///   U(q) = 1/2 q' K_b q + 1/2 EAl eps^2,   eps = L q + 1/2 sum_i p_i (G_i q)^2
///
/// Rows of G: v_C' at three Gauss stations, w_C' at the same, rx'. The same energy as spatial_beam's maps with the
/// averaged strain.
struct FixedSpatialBeam {
  Matrix12 bending;                ///< K_b: bending and torsion
  double axial;                    ///< EA l [N m]
  Eigen::Matrix<double, 1, 12> L;  ///< [1/m], [-]
  Eigen::Matrix<double, 7, 12> G;  ///< slopes
  Eigen::Matrix<double, 7, 1> p;   ///< weights; the last is Ip/A with wagner, else 0
};

/// @throws floe::InputError  as spatial_beam
FixedSpatialBeam fixed_spatial_beam(const BeamPlace& place, const SpatialBeamSection& section, bool wagner = false);

/// Consistent mass, 12 x 12: the mass points' N'N integrated over the section in closed form, four stations along.
/// @throws floe::InputError  as spatial_beam
Matrix12 spatial_beam_mass(const BeamPlace& place, const SpatialBeamSection& section);

/// K = K_b + EAl L'L.
Matrix12 stiffness(const FixedSpatialBeam& beam);

double energy(const FixedSpatialBeam& beam, const Vector12& q);  ///< U(q) [J]

/// dU/dq and d2U/dq2, exact.
Vector12 force(const FixedSpatialBeam& beam, const Vector12& q);    ///< dU/dq
Matrix12 tangent(const FixedSpatialBeam& beam, const Vector12& q);  ///< d2U/dq2

/// (dK/deta_b) a = EAl [ L' e(a, b) + e(a, .)' L b + e(b, .)' L a ]; symmetric in a, b.
Vector12 stiffness_derivative(const FixedSpatialBeam& beam, const Vector12& a, const Vector12& b);

}  // namespace floe::fem
