#include "spatial_beam_fields.h"

#include "floe/error.h"

namespace floe::fem {

Eigen::Matrix3d element_axes(const BeamPlace& place) {
  const Eigen::Vector3d along = place.to - place.from;
  const double length = along.norm(), size = place.orientation.norm();
  if (!(length > 0) || !along.allFinite()) throw InputError("a beam element's nodes coincide");
  if (!(size > 0) || !place.orientation.allFinite()) throw InputError("a beam's orientation vector is zero");
  const Eigen::Vector3d x = along / length, side = place.orientation / size;
  const Eigen::Vector3d across = side - side.dot(x) * x;
  if (across.norm() < 1e-6) throw InputError("a beam's orientation vector is parallel to the beam");
  Eigen::Matrix3d axes;
  const Eigen::Vector3d y = (across - across.dot(x) * x).normalized();
  axes << x, y, x.cross(y);
  return axes;
}

namespace spatial {
namespace {

/// Hermite cubics on (value, slope) at both ends and their derivatives with respect to x.
using Row4 = Eigen::Matrix<double, 1, 4>;
Row4 cubics(double s, double l) {
  return {1 - 3 * s * s + 2 * s * s * s, l * s * (1 - s) * (1 - s), 3 * s * s - 2 * s * s * s, l * s * s * (s - 1)};
}
Row4 cubic_slopes(double s, double l) {
  return {6 * s * (s - 1) / l, 1 - 4 * s + 3 * s * s, 6 * s * (1 - s) / l, s * (3 * s - 2)};
}
Row4 cubic_curvatures(double s, double l) {
  return {(12 * s - 6) / (l * l), (6 * s - 4) / l, (6 - 12 * s) / (l * l), (6 * s - 2) / l};
}

Row12 in_y(const Row4& h) {
  Row12 row = Row12::Zero();
  row[1] = h[0], row[5] = h[1], row[7] = h[2], row[11] = h[3];  // v' = rz
  return row;
}
Row12 in_z(const Row4& h) {
  Row12 row = Row12::Zero();
  row[2] = h[0], row[4] = -h[1], row[8] = h[2], row[10] = -h[3];  // w' = -ry
  return row;
}

/// l (s - 3 s^2 + 2 s^3) and its derivative with respect to x, on gamma.
double sway(double s, double l) { return l * s * (1 - s) * (1 - 2 * s); }
double sway_slope(double s) { return 1 - 6 * s + 6 * s * s; }
double sway_curvature(double s, double l) { return (12 * s - 6) / l; }

Eigen::Matrix2d bending_of(const SpatialBeamSection& section) {
  return (Eigen::Matrix2d() << section.EIz, section.EIyz, section.EIyz, section.EIy).finished();
}

/// 1 + 12/l^2 GA^-1 B.
Eigen::Matrix2d softening(const SpatialBeamSection& section, double l) {
  return Eigen::Matrix2d::Identity() + 12 / (l * l) * section.GA.cwiseInverse().asDiagonal() * bending_of(section);
}

}  // namespace

ShearRows antisymmetric(double l) {
  ShearRows D;
  D << in_y({-1, -l / 2, 1, -l / 2}), in_z({-1, -l / 2, 1, -l / 2});
  return D;
}

Eigen::Matrix2d antisymmetric_stiffness(const SpatialBeamSection& section, double l) {
  const Eigen::Matrix2d K = 12 / (l * l * l) * bending_of(section) * softening(section, l).inverse();
  return (K + K.transpose()) / 2;
}

BeamFrame beam_frame(const BeamPlace& place, const SpatialBeamSection& section) {
  check(section);
  BeamFrame frame;
  frame.axes = element_axes(place);
  frame.length = (place.to - place.from).norm();
  frame.C = section.centroid, frame.S = section.shear_centre;
  const Eigen::Matrix3d rotation = frame.axes.transpose();
  frame.node.setZero();
  frame.node.topLeftCorner<3, 3>() = rotation;
  frame.node.bottomRightCorner<3, 3>() = rotation;
  Eigen::Matrix3d arms;  // u_C = u + z_C ry - y_C rz,  v_S = v - z_S rx,  w_S = w + y_S rx
  arms << 0, frame.C[1], -frame.C[0], -frame.S[1], 0, 0, frame.S[0], 0, 0;
  frame.node.topRightCorner<3, 3>() = arms * rotation;
  frame.shear.setZero();
  if (section.shears()) {
    const double l = frame.length;
    const Eigen::Matrix2d B = 12 / (l * l * l) * section.GA.cwiseInverse().asDiagonal() * bending_of(section);
    frame.shear = softening(section, l).inverse() * B * antisymmetric(l);
  }
  return frame;
}

Row12 stretch(double s) {
  Row12 row = Row12::Zero();
  row[0] = 1 - s, row[6] = s;
  return row;
}
Row12 twist(double s) {
  Row12 row = Row12::Zero();
  row[3] = 1 - s, row[9] = s;
  return row;
}
Row12 deflection_y(double s, const BeamFrame& f) {
  return in_y(cubics(s, f.length)) + sway(s, f.length) * f.shear.row(0);
}
Row12 deflection_z(double s, const BeamFrame& f) {
  return in_z(cubics(s, f.length)) + sway(s, f.length) * f.shear.row(1);
}
Row12 slope_y(double s, const BeamFrame& f) { return in_y(cubic_slopes(s, f.length)) + sway_slope(s) * f.shear.row(0); }
Row12 slope_z(double s, const BeamFrame& f) { return in_z(cubic_slopes(s, f.length)) + sway_slope(s) * f.shear.row(1); }
Row12 curvature_y(double s, const BeamFrame& f) {
  return in_y(cubic_curvatures(s, f.length)) + sway_curvature(s, f.length) * f.shear.row(0);
}
Row12 curvature_z(double s, const BeamFrame& f) {
  return in_z(cubic_curvatures(s, f.length)) + sway_curvature(s, f.length) * f.shear.row(1);
}

Row12 stretch_rate(double l) {
  Row12 row = Row12::Zero();
  row[0] = -1 / l, row[6] = 1 / l;
  return row;
}
Row12 twist_rate(double l) {
  Row12 row = Row12::Zero();
  row[3] = -1 / l, row[9] = 1 / l;
  return row;
}
Row12 centroid_slope_y(double s, const BeamFrame& f) {
  return slope_y(s, f) - (f.C[1] - f.S[1]) * twist_rate(f.length);
}
Row12 centroid_slope_z(double s, const BeamFrame& f) {
  return slope_z(s, f) + (f.C[0] - f.S[0]) * twist_rate(f.length);
}

SectionMotion section_motion(double s, const BeamFrame& f) {
  const Row12 rotation = twist(s), none = Row12::Zero();
  SectionMotion motion;
  motion.centre << stretch(s), deflection_y(s, f) - (f.C[1] - f.S[1]) * rotation,
      deflection_z(s, f) + (f.C[0] - f.S[0]) * rotation;
  motion.along_y << f.shear.row(0) - slope_y(s, f), none, rotation;  // sections rotate by what is no shear
  motion.along_z << f.shear.row(1) - slope_z(s, f), -rotation, none;
  return motion;
}

}  // namespace spatial
}  // namespace floe::fem
