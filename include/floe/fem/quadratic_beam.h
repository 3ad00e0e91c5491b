#pragma once
#include "floe/fem/spatial_beam.h"

namespace floe::fem {

/// Where a beam of second order lies: its ends, a node between them off which it may curve, and a vector that rotates
/// its section, as BeamPlace has it about the tangent.
struct BeamCurve {
  Eigen::Vector3d from, to, middle, orientation;
};

/// Timoshenko beam of three nodes, dofs (u, v, w, rotation vector) at `from`, `to`, `middle`, body axes. The nodes'
/// displacements u_i and section axes D_y, D_z, which exp(theta_i) rotates, are interpolated by the quadratic shape
/// functions N_i, X = sum N_i X_i, D_a = sum N_i D_a,i, d_a = sum N_i (theta_i x D_a,i + 1/2 theta_i x (theta_i x
/// D_a,i)); with ' = d/ds and t = X':
///
///   eps = t.u' + 1/2 u'.u',   b_a = t.d_a' + D_a'.u' + v'.d_a',   gamma_a = t.d_a + D_a.u' + v'.d_a + 1/3 (t.u')
///   (t.d_a) tau = 1/2 (D_z.d_y' + D_y'.d_z - D_y.d_z' - D_z'.d_y + d_y'.d_z - d_z'.d_y) 2 U = int EA eps_C^2 + EIz
///   b_y^2 + EIy b_z^2 + 2 EIyz b_y b_z + GJ tau^2 + GAy gamma_y,S^2 + GAz gamma_z,S^2
///
/// (the strain at y, z is eps + y b_y + z b_z). v' = u' - t (t.u') is of first order where the line does not stretch,
/// t.u' of second: what the latter multiplies is of third order, and its factors, 0 and 1/3, are such that strains at a
/// rotation about one axis are exact to the third order. eps_C = eps + y_C b_y + z_C b_z at the centroid, gamma_y,S =
/// gamma_y - z_S tau, gamma_z,S = gamma_z + y_S tau at the shear centre. All are taken at two Gauss points, where
/// nothing locks. With Strains::von_karman they are linear but for 1/2 (v_C'^2 + w_C'^2) in eps_C; with second_order
/// all terms of second order are there and `bending` is zero. `wagner` as in spatial_beam. A section without GA gets
/// 1e4 times the 12 EI / l^2 at which shear bends the element as far as moments do.
///
/// Mass points stand at three Gauss stations, with the section's points and rotation as in spatial_beam.
/// @throws InputError  no length, folded, or the orientation is zero or parallel to it; the section (check)
/// Source: Crisfield 1986, Finite elements and solution procedures for structural analysis; Simo & Vu-Quoc 1986.
ElementMaps quadratic_beam(const BeamCurve& curve, const SpatialBeamSection& section,
                           const SpatialBeamStrain& strain = {});

/// Uniform samples of the line of the nodes (weight per length 1).
std::vector<body::MassPoint> quadratic_beam_line(const BeamCurve& curve);

/// Part of the length that is nearest to a node: length, centre, and int (x - centre)(x - centre)' [m3].
struct BeamShare {
  double length = 0;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero(), axes = Eigen::Matrix3d::Zero();  ///< axes: of the section there
};
std::array<BeamShare, 3> quadratic_beam_shares(const BeamCurve& curve);

/// The tangent and two directions normal to it at each of three nodes, columns.
std::vector<Eigen::Matrix3d> curve_axes(const std::vector<Eigen::Vector3d>& nodes);

}  // namespace floe::fem
