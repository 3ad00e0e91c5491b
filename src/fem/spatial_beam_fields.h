#pragma once
#include <array>

#include "floe/fem/spatial_beam_fixed.h"

namespace floe::fem::spatial {

struct BeamStation {
  double at, weight;  // on [0, 1]
};

/// Gauss-Legendre, exact to degree 5, 7 and 9. Source: Abramowitz & Stegun, table 25.4.
inline constexpr std::array<BeamStation, 3> beam_gauss3{
    {{0.5 - 0.38729833462074168852, 5.0 / 18}, {0.5, 8.0 / 18}, {0.5 + 0.38729833462074168852, 5.0 / 18}}};
inline constexpr std::array<BeamStation, 4> beam_gauss4{{{0.5 - 0.43056815579702628761, 0.17392742256872692869},
                                                         {0.5 - 0.16999052179242813240, 0.32607257743127307131},
                                                         {0.5 + 0.16999052179242813240, 0.32607257743127307131},
                                                         {0.5 + 0.43056815579702628761, 0.17392742256872692869}}};
inline constexpr std::array<BeamStation, 5> beam_gauss5{{{0.5 - 0.45308992296933199640, 0.11846344252809454376},
                                                         {0.5 - 0.26923465505284154552, 0.23931433524968323402},
                                                         {0.5, 0.28444444444444444444},
                                                         {0.5 + 0.26923465505284154552, 0.23931433524968323402},
                                                         {0.5 + 0.45308992296933199640, 0.11846344252809454376}}};

using Row12 = Eigen::Matrix<double, 1, 12>;
using Rows3x12 = Eigen::Matrix<double, 3, 12>;
using ShearRows = Eigen::Matrix<double, 2, 12>;

/// The element's own dofs are (u_C, v_S, w_S, rx, ry, rz) at two nodes, element axes.
struct BeamFrame {
  double length;
  Eigen::Matrix3d axes;              // columns x, y, z in body axes
  Eigen::Matrix<double, 6, 6> node;  // own dofs of a node from its body dofs
  Eigen::Vector2d C, S;              // centroid and shear centre from the line of the nodes
  ShearRows shear;                   // gamma_y, gamma_z on own dofs; zero where the section is rigid in shear
};
BeamFrame beam_frame(const BeamPlace& place, const SpatialBeamSection& section);

/// With shear the line rotates by rz + gamma_y and -ry + gamma_z where sections rotate by rz and ry. Gamma is constant,
/// from the equilibrium of an element without load, GA gamma = EI d3v/dx3:
///
///   (1 + 12/l^2 GA^-1 B) gamma = 12/l^3 GA^-1 B D,   D = (v_2 - v_1 - l (rz_1 + rz_2)/2, w_2 - w_1 + l (ry_1 +
///   ry_2)/2), v = cubic + l (s - 3 s^2 + 2 s^3) gamma_y,       B = [EIz EIyz; EIyz EIy]
///
/// which are Timoshenko's exact shapes. What bends with constant curvature has no shear.
/// Source: Przemieniecki, Theory of matrix structural analysis, ch. 5; Friedman & Kosmatka, Comput. Struct. 47 (1993)
/// 473.
ShearRows antisymmetric(double l);  // D on own dofs
/// 12/l^3 B (1 + 12/l^2 GA^-1 B)^-1: what D costs.
Eigen::Matrix2d antisymmetric_stiffness(const SpatialBeamSection& section, double l);

/// Fields at s = x / l on the element's own dofs.
Row12 stretch(double s);
Row12 twist(double s);
Row12 deflection_y(double s, const BeamFrame& frame);
Row12 deflection_z(double s, const BeamFrame& frame);
Row12 slope_y(double s, const BeamFrame& frame);      // v_S'
Row12 slope_z(double s, const BeamFrame& frame);      // w_S'
Row12 curvature_y(double s, const BeamFrame& frame);  // v_S'', of line and sections alike
Row12 curvature_z(double s, const BeamFrame& frame);  // w_S''

/// u_C', v_C', w_C', rx'.
Row12 stretch_rate(double l);
Row12 twist_rate(double l);
Row12 centroid_slope_y(double s, const BeamFrame& frame);
Row12 centroid_slope_z(double s, const BeamFrame& frame);

/// N(y, z) = centre + (y - y_C) along_y + (z - z_C) along_z, in element axes on own dofs.
struct SectionMotion {
  Rows3x12 centre, along_y, along_z;
};
SectionMotion section_motion(double s, const BeamFrame& frame);

/// Strains of second order (spatial_beam), bending and torsion among them: points (eps, tau), the mean curvatures
/// (kappa_z, -kappa_y) of the element, and their odd parts.
std::vector<StrainPoint> second_order_strains(const BeamFrame& frame, const SpatialBeamSection& section, bool wagner);

/// Points with the section's mass, centre and second moments.
struct SectionPoint {
  double share;         ///< of the mass
  Eigen::Vector2d arm;  ///< [y, z] from the centroid
};
std::vector<SectionPoint> section_points(const SpatialBeamSection& section);

/// Rows on own dofs -> rows on body dofs.
template <int rows>
Eigen::Matrix<double, rows, 12> to_body(const Eigen::Matrix<double, rows, 12>& own, const BeamFrame& frame) {
  Eigen::Matrix<double, rows, 12> body;
  body.template leftCols<6>().noalias() = own.template leftCols<6>() * frame.node;
  body.template rightCols<6>().noalias() = own.template rightCols<6>() * frame.node;
  return body;
}

}  // namespace floe::fem::spatial
