#include "floe/fem/spatial_beam.h"

#include <cmath>

#include "spatial_beam_fields.h"

namespace floe::fem {
using namespace spatial;

std::vector<SectionPoint> spatial::section_points(const SpatialBeamSection& section) {
  if (section.rhoA == 0) return {};
  Eigen::Matrix2d second;
  second << section.rhoIz, section.rhoIyz, section.rhoIyz, section.rhoIy;
  second /= section.rhoA;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> principal(second);
  const Eigen::Vector2d& s = principal.eigenvalues();
  const auto counts = [&](int i) { return s[i] > 1e-14 * s[1]; };
  const int n = counts(0) + counts(1);
  if (n == 0) return {{1, Eigen::Vector2d::Zero()}};
  std::vector<SectionPoint> points;
  for (int i = 0; i < 2; ++i) {
    if (!counts(i)) continue;
    const Eigen::Vector2d arm = std::sqrt(n * s[i]) * principal.eigenvectors().col(i);
    points.push_back({0.5 / n, arm});
    points.push_back({0.5 / n, -arm});
  }
  return points;
}

namespace {

body::MassPoint sample(double mass, double s, const Eigen::Vector2d& arm, const BeamPlace& place,
                       const BeamFrame& frame) {
  const SectionMotion motion = section_motion(s, frame);
  const Rows3x12 own = motion.centre + arm[0] * motion.along_y + arm[1] * motion.along_z;
  const Eigen::Vector3d x(s * frame.length, frame.C[0] + arm[0], frame.C[1] + arm[1]);
  return {mass, place.from + frame.axes * x, frame.axes * to_body<3>(own, frame)};
}

/// The rotation vector of the section on body dofs: (rx, -w_S', v_S'), with shear that of the section.
Eigen::Matrix<double, 3, 12> section_rotation(double s, const BeamFrame& frame) {
  const SectionMotion motion = section_motion(s, frame);
  Rows3x12 own;
  own << twist(s), motion.along_z.row(0), -motion.along_y.row(0);
  return frame.axes * to_body<3>(own, frame);
}

StrainPoint whole_element(const FixedSpatialBeam& beam, double EA, double length, bool wagner) {
  const int rows = wagner ? 7 : 6;
  const Eigen::MatrixXd P = beam.p.head(rows).asDiagonal();
  return {length, Eigen::MatrixXd::Constant(1, 1, EA), beam.L, beam.G.topRows(rows), {P}};
}

StrainPoint station(const BeamStation& g, const FixedSpatialBeam& beam, double EA, const BeamFrame& frame,
                    double radius_squared) {
  const int rows = radius_squared > 0 ? 3 : 2;
  Eigen::MatrixXd G(rows, 12), P = Eigen::MatrixXd::Identity(rows, rows);
  G.row(0) = to_body<1>(centroid_slope_y(g.at, frame), frame);
  G.row(1) = to_body<1>(centroid_slope_z(g.at, frame), frame);
  if (rows == 3) G.row(2) = beam.G.row(6), P(2, 2) = radius_squared;
  return {g.weight * frame.length, Eigen::MatrixXd::Constant(1, 1, EA), beam.L, G, {P}};
}

}  // namespace

ElementMaps spatial_beam(const BeamPlace& place, const SpatialBeamSection& section, const SpatialBeamStrain& strain) {
  const BeamFrame frame = beam_frame(place, section);
  const FixedSpatialBeam beam = fixed_spatial_beam(place, section, strain.wagner);
  ElementMaps maps;
  maps.bending = strain.strains == Strains::second_order ? Matrix12::Zero().eval() : beam.bending;
  if (strain.strains == Strains::second_order) {
    maps.membrane = second_order_strains(frame, section, strain.wagner);
  } else if (strain.membrane == MembraneStrain::averaged) {
    maps.membrane.push_back(whole_element(beam, section.EA, frame.length, strain.wagner));
  } else {
    for (const BeamStation& g : beam_gauss5)  // slopes to the fourth have degree 8
      maps.membrane.push_back(station(g, beam, section.EA, frame, beam.p[6]));
  }
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();  // about the centroid, int rho a a'
  second.bottomRightCorner<2, 2>() << section.rhoIz, section.rhoIyz, section.rhoIyz, section.rhoIy;
  second = (frame.axes * second * frame.axes.transpose()).eval();
  const Eigen::Vector3d arm = frame.axes.rightCols<2>() * section.centroid;
  for (const BeamStation& g : beam_gauss4) {
    body::RotatingForms forms(g.weight * frame.length * second);
    forms.add(section.rhoA * g.weight * frame.length, place.from + g.at * frame.length * frame.axes.col(0) + arm,
              Eigen::Matrix3d::Identity(), arm);
    if (!forms.empty()) maps.rotary.emplace_back(forms, section_rotation(g.at, frame));
  }
  const std::vector<SectionPoint> points = section_points(section);
  for (const BeamStation& g : beam_gauss4)
    for (const SectionPoint& point : points)
      maps.mass.push_back(sample(section.rhoA * g.weight * frame.length * point.share, g.at, point.arm, place, frame));
  return maps;
}

std::vector<body::MassPoint> spatial_beam_line(const BeamPlace& place, const SpatialBeamSection& section,
                                               const Eigen::Vector2d& at) {
  const BeamFrame frame = beam_frame(place, section);
  std::vector<body::MassPoint> line;
  for (const BeamStation& g : beam_gauss4)
    line.push_back(sample(g.weight * frame.length, g.at, at - section.centroid, place, frame));
  return line;
}

}  // namespace floe::fem
