#include "floe/fem/spatial_beam_fixed.h"

#include "spatial_beam_fields.h"

namespace floe::fem {
using namespace spatial;

namespace {

/// T'KT for T = diag(node, node).
Matrix12 congruent(const Matrix12& K, const BeamFrame& frame) {
  Matrix12 result;
  for (int i = 0; i < 12; i += 6)
    for (int j = 0; j < 12; j += 6) {
      const Eigen::Matrix<double, 6, 6> right = K.block<6, 6>(i, j) * frame.node;
      result.block<6, 6>(i, j).noalias() = frame.node.transpose() * right;
    }
  return result;
}

Matrix12 bending_and_torsion(const SpatialBeamSection& section, double l) {
  const double c = 1 / (l * l * l);
  Matrix12 K = Matrix12::Zero();
  if (section.shears()) {  // an even bending, and an odd one, against which shear gives way
    const ShearRows odd = antisymmetric(l);
    ShearRows even = ShearRows::Zero();  // the change of the slopes v' = rz and w' = -ry
    even(0, 5) = even(1, 10) = -1, even(0, 11) = even(1, 4) = 1;
    Eigen::Matrix2d EI;
    EI << section.EIz, section.EIyz, section.EIyz, section.EIy;
    K = even.transpose() * (EI / l) * even + odd.transpose() * antisymmetric_stiffness(section, l) * odd;
  } else {
    Eigen::Matrix4d b;
    b << 12, 6 * l, -12, 6 * l, 6 * l, 4 * l * l, -6 * l, 2 * l * l, -12, -6 * l, 12, -6 * l, 6 * l, 2 * l * l, -6 * l,
        4 * l * l;
    constexpr int v[4] = {1, 5, 7, 11}, w[4] = {2, 4, 8, 10};
    constexpr double sign[4] = {1, -1, 1, -1};  // w' = -ry
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) {
        K(v[i], v[j]) = section.EIz * c * b(i, j);
        K(w[i], w[j]) = section.EIy * c * b(i, j) * sign[i] * sign[j];
        K(v[i], w[j]) = section.EIyz * c * b(i, j) * sign[j];
        K(w[j], v[i]) = K(v[i], w[j]);
      }
  }
  K(3, 3) = K(9, 9) = section.GJ / l;
  K(3, 9) = K(9, 3) = -section.GJ / l;
  return K;
}

struct Evaluated {
  Eigen::Matrix<double, 7, 1> weighted;  // p_i G_i q
  double eps;
};

Evaluated evaluate(const FixedSpatialBeam& beam, const Vector12& q) {
  const Eigen::Matrix<double, 7, 1> slopes = beam.G * q;
  Evaluated e{beam.p.cwiseProduct(slopes), 0};
  e.eps = beam.L.dot(q) + e.weighted.dot(slopes) / 2;
  return e;
}

}  // namespace

FixedSpatialBeam fixed_spatial_beam(const BeamPlace& place, const SpatialBeamSection& section, bool wagner) {
  const BeamFrame frame = beam_frame(place, section);
  const double l = frame.length;
  FixedSpatialBeam beam;
  beam.bending = congruent(bending_and_torsion(section, l), frame);
  beam.axial = section.EA * l;
  beam.L = to_body<1>(stretch_rate(l), frame);
  for (int i = 0; i < 3; ++i) {
    const BeamStation& g = beam_gauss3[i];  // slopes squared have degree 4
    beam.G.row(i) = to_body<1>(centroid_slope_y(g.at, frame), frame);
    beam.G.row(i + 3) = to_body<1>(centroid_slope_z(g.at, frame), frame);
    beam.p[i] = beam.p[i + 3] = g.weight;
  }
  beam.G.row(6) = to_body<1>(twist_rate(l), frame);
  beam.p[6] = wagner ? (section.EIy + section.EIz) / section.EA : 0;
  return beam;
}

Matrix12 spatial_beam_mass(const BeamPlace& place, const SpatialBeamSection& section) {
  const BeamFrame frame = beam_frame(place, section);
  Matrix12 M = Matrix12::Zero();
  for (const BeamStation& g : beam_gauss4) {
    const SectionMotion N = section_motion(g.at, frame);
    const double w = g.weight * frame.length;
    const Rows3x12 y = section.rhoIz * N.along_y + section.rhoIyz * N.along_z;
    const Rows3x12 z = section.rhoIyz * N.along_y + section.rhoIy * N.along_z;
    M.noalias() += (w * section.rhoA) * N.centre.transpose() * N.centre;
    M.noalias() += w * N.along_y.transpose() * y;
    M.noalias() += w * N.along_z.transpose() * z;
  }
  return congruent(M, frame);
}

Matrix12 stiffness(const FixedSpatialBeam& beam) { return beam.bending + beam.axial * beam.L.transpose() * beam.L; }

double energy(const FixedSpatialBeam& beam, const Vector12& q) {
  const double eps = evaluate(beam, q).eps;
  return (q.dot(beam.bending * q) + beam.axial * eps * eps) / 2;
}

Vector12 force(const FixedSpatialBeam& beam, const Vector12& q) {
  const Evaluated e = evaluate(beam, q);
  Vector12 f = beam.bending * q;
  f.noalias() += (beam.axial * e.eps) * (beam.L.transpose() + beam.G.transpose() * e.weighted);
  return f;
}

Matrix12 tangent(const FixedSpatialBeam& beam, const Vector12& q) {
  const Evaluated e = evaluate(beam, q);
  const Vector12 gradient = beam.L.transpose() + beam.G.transpose() * e.weighted;
  const Eigen::Matrix<double, 7, 12> weighted = beam.p.asDiagonal() * beam.G;
  Matrix12 K = beam.bending;
  K.noalias() += beam.axial * gradient * gradient.transpose();
  K.noalias() += (beam.axial * e.eps) * beam.G.transpose() * weighted;
  return K;
}

Vector12 stiffness_derivative(const FixedSpatialBeam& beam, const Vector12& a, const Vector12& b) {
  const Eigen::Matrix<double, 7, 1> slope_a = beam.G * a, slope_b = beam.p.cwiseProduct(beam.G * b);
  const Eigen::Matrix<double, 7, 1> crossed = beam.L.dot(b) * beam.p.cwiseProduct(slope_a) + beam.L.dot(a) * slope_b;
  return beam.axial * (slope_a.dot(slope_b) * beam.L.transpose() + beam.G.transpose() * crossed);
}

}  // namespace floe::fem
