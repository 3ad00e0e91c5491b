#include "corotational_beam_forces.h"

// U = 1/2 EA l0 eps^2 + 1/2 a' B a,   eps = (l - l0)/l0 + 1/2 a' S a,   l a function of r2 - r1.
namespace floe::reference::corotational {

double membrane_strain(const Moments& m, double length, const Chord& chord) {
  return chord.elongation / length + chord.local.dot(m.slope * chord.local) / 2;
}

double elastic_energy(const Moments& m, double length, const Chord& chord) {
  const double eps = membrane_strain(m, length, chord);
  return m.axial * length * length * eps * eps / 2 + chord.local.dot(m.bending * chord.local) / 2;
}

Seven elastic_force(const Moments& m, double length, const Chord& chord) {
  const double N = m.axial * length * membrane_strain(m, length, chord);
  Seven f = Seven::Zero();
  f[0] = -N;
  f[2] = N;
  f.segment<2>(4) = N * length * (m.slope * chord.local) + m.bending * chord.local;
  return f;
}

SevenSquare elastic_stiffness(const Moments& m, double length, const Chord& chord) {
  const double N = m.axial * length * membrane_strain(m, length, chord);
  const Eigen::Vector2d slope = m.slope * chord.local;
  const Eigen::Vector2d coupling = m.axial * length * slope;
  SevenSquare K = SevenSquare::Zero();
  K(0, 0) = K(2, 2) = m.axial;
  K(0, 2) = K(2, 0) = -m.axial;
  K(1, 1) = K(3, 3) = N / chord.length;  // N e rotates with the chord
  K(1, 3) = K(3, 1) = -N / chord.length;
  K.block<2, 1>(4, 0) = -coupling;
  K.block<2, 1>(4, 2) = coupling;
  K.block<1, 2>(0, 4) = -coupling.transpose();
  K.block<1, 2>(2, 4) = coupling.transpose();
  K.block<2, 2>(4, 4) = length * coupling * slope.transpose() + N * length * m.slope + m.bending;
  return K;
}

namespace {

/// EA eps.
double force_rate(const Moments& m, double length, const Chord& chord, const Seven& v) {
  return m.axial * (v[2] - v[0] + length * chord.local.dot(m.slope * v.segment<2>(4)));
}

/// The axial force of a beam and its moments at the nodes, on z.
Seven of_axial_force(const Moments& m, double length, const Chord& chord, double N) {
  Seven f = Seven::Zero();
  f[0] = -N, f[2] = N;
  f.segment<2>(4) = N * length * (m.slope * chord.local);
  return f;
}

}  // namespace

Seven viscous_force(const Moments& m, double length, const Chord& chord, const Seven& velocity) {
  Seven f = of_axial_force(m, length, chord, force_rate(m, length, chord, velocity));
  f.segment<2>(4) += m.bending * velocity.segment<2>(4);
  return f;
}

void add_viscous_tangent(const Moments& m, double length, const Chord& chord, const Seven& velocity, double weight,
                         ForceTangent& by) {
  const double N = weight * force_rate(m, length, chord, velocity);
  const Seven unit = weight * of_axial_force(m, length, chord, 1);
  Seven of_z = Seven::Zero();  // d(EA eps.): e rotates with the chord
  of_z[3] = m.axial * (velocity[3] - velocity[1]) / chord.length, of_z[1] = -of_z[3];
  of_z.segment<2>(4) = m.axial * length * (m.slope * velocity.segment<2>(4));
  by.K += unit * of_z.transpose();
  by.K(1, 1) += N / chord.length, by.K(3, 3) += N / chord.length;
  by.K(1, 3) -= N / chord.length, by.K(3, 1) -= N / chord.length;
  by.K.block<2, 2>(4, 4) += N * length * m.slope;
  by.C += unit * (m.axial * of_axial_force(m, length, chord, 1)).transpose();
  by.C.block<2, 2>(4, 4) += weight * m.bending;
}

}  // namespace floe::reference::corotational
