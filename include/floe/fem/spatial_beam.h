#pragma once
#include "floe/fem/beam_section_3d.h"
#include "floe/fem/element.h"
#include "floe/fem/planar_beam.h"
#include "floe/fem/strains.h"

namespace floe::fem {

/// Where a spatial beam element lies: its nodes in body axes, apart from each other, and a vector that rotates its
/// section.
///
/// Element axes: x from the first node to the second, y in the plane of x and `orientation` (on its side), z = x cross
/// y.
struct BeamPlace {
  Eigen::Vector3d from, to, orientation;
};

/// @return columns x, y, z of the element in body axes
/// @throws floe::InputError  nodes coincide, or `orientation` is zero or parallel to the element (to 1e-6 rad)
Eigen::Matrix3d element_axes(const BeamPlace& place);

/// `wagner` adds the lengthening of fibres by twist, so that tension stiffens torsion.
struct SpatialBeamStrain {
  MembraneStrain membrane = MembraneStrain::averaged;
  bool wagner = false;
  Strains strains = Strains::von_karman;
};

/// Spatial beam element with von Karman strain, Euler-Bernoulli's, or Timoshenko's where GA is given: u and twist
/// linear, v and w cubic; dofs (u, v, w, rx, ry, rz) at two nodes, body axes, rotations about the axes by the right
/// hand: v' = rz, w' = -ry (with shear: + gamma, which is constant in the element and makes its shapes those of a beam
/// without load).
///
/// C the centroid and S the shear centre, carried by the nodes through rigid arms; (y, z) from the line of the nodes:
///   eps = u_C' + 1/2 (v_C'^2 + w_C'^2) [+ 1/2 (Ip/A) rx'^2, wagner]           Ip/A = (EIy + EIz)/EA
///   2 U = int EA eps^2 + EIz v_S''^2 + EIy w_S''^2 + 2 EIyz v_S'' w_S'' + GJ rx'^2
///   displacement of (y, z):  u_C - (y - y_C) v_S' - (z - z_C) w_S',   v_S - (z - z_S) rx,   w_S + (y - y_S) rx
/// With shear sections rotate by v_S' - gamma_y and w_S' - gamma_z, and 2 U has + int GAy gamma_y^2 + GAz gamma_z^2.
/// The slopes in eps are those of the line of centroids, v_C = v_S - (z_C - z_S) rx and w_C = w_S + (y_C - y_S) rx, so
/// that an offset stays inside the square. `averaged` takes the mean of eps over the element (no membrane locking).
/// Not in the model: warping, and strains of second order that vary over the section (of these,
/// wagner keeps the mean: its rx'^4 term has Ip^2/A where the section has int r^4 dA >= Ip^2/A).
///
/// With Strains::second_order, averaged alone, all terms of second order are in the strains (theory.md) and
/// `bending` is zero; phi = rx, at the nodes v' = rz + 1/2 rx ry and w' = -ry + 1/2 rx rz, and C and S move by
/// r x a + 1/2 r x (r x a):
///   eps = u_C' + 1/2 (v_C'^2 + w_C'^2),   tau = phi' + 1/2 (w' v'' - v' w''),
///   kappa_z = v'' + phi w'',   kappa_y = -w'' + phi v''
///
/// Mass points stand at four Gauss stations, in each at +-sqrt(n s/rhoA) along the n = 2 principal axes of the section
/// (n = 1, or one point, where second moments s vanish): total, first and second moments and consistent mass are exact.
/// They rotate with the section about its centroid to second order (body::RotatingMass), by (rx, -w_S' + gamma_z, v_S'
/// - gamma_y); an offset of the centroid is an arm of first order.
/// Source: Przemieniecki, Theory of matrix structural analysis, ch. 5 and 11 (linear part); Hodges & Dowell, NASA TN
/// D-7818, 1974 (rx'^2 in the axial strain).
/// @throws floe::InputError  place (element_axes) or section (check) not admissible
ElementMaps spatial_beam(const BeamPlace& place, const SpatialBeamSection& section,
                         const SpatialBeamStrain& strain = {});

/// Uniform samples (weight per length 1) of the line of material points at `at` = [y, z] from the line of the nodes:
/// what distributed loads act on. Exact for loads of degree 4 along the element.
/// @throws floe::InputError  as spatial_beam
std::vector<body::MassPoint> spatial_beam_line(const BeamPlace& place, const SpatialBeamSection& section,
                                               const Eigen::Vector2d& at = Eigen::Vector2d::Zero());

}  // namespace floe::fem
