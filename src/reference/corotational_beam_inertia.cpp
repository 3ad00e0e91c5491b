#include "corotational_beam_forces.h"

// r = (1 - xi) r1 + xi r2 + n w, w = phi.a, gives with the rotating rate b = dbeta/dt
//     r.. = (1 - xi) r1.. + xi r2.. + n phi.A - e phi.B,    A = a.. - b^2 a,    B = 2 b a. + b. a
// and dr = (1 - xi) dr1 + xi dr2 + n phi.da - e w dbeta. The section rotates by psi = beta + alpha.a, where int alpha_i
// dx = c l0, zero without shear.
namespace floe::reference::corotational {

double kinetic_energy(const Moments& m, const Chord& chord, const Seven& v) {
  const auto v1 = v.head<2>(), v2 = v.segment<2>(2), rate = v.segment<2>(4);
  const auto& a = chord.local;
  const double b = v[6];
  return m.mass / 6 * (v1.dot(v1) + v1.dot(v2) + v2.dot(v2)) + rate.dot(m.first * v1[1] + m.last * v2[1]) -
         b * a.dot(m.first * v1[0] + m.last * v2[0]) + rate.dot(m.deflection * rate) / 2 +
         b * b * a.dot(m.deflection * a) / 2 +
         m.rotary / 2 * (b * b + 2 * b * m.mean_rotation.dot(rate) + rate.dot(m.rotation * rate));
}

Seven inertia_force(const Moments& m, const Chord& chord, const Rates& rates) {
  const auto a1 = rates.acceleration.head<2>(), a2 = rates.acceleration.segment<2>(2);
  const auto& a = chord.local;
  const Eigen::Vector2d rate = rates.velocity.segment<2>(4), second = rates.acceleration.segment<2>(4);
  const double b = rates.velocity[6], spin = rates.acceleration[6];
  const Eigen::Vector2d A = second - b * b * a, B = 2 * b * rate + spin * a;
  Seven f;
  f.head<2>() = m.mass / 6 * (2 * a1 + a2) + Eigen::Vector2d(-m.first.dot(B), m.first.dot(A));
  f.segment<2>(2) = m.mass / 6 * (a1 + 2 * a2) + Eigen::Vector2d(-m.last.dot(B), m.last.dot(A));
  f.segment<2>(4) =
      m.first * a1[1] + m.last * a2[1] + m.deflection * A + m.rotary * (m.rotation * second + spin * m.mean_rotation);
  f[6] = -a.dot(m.first * a1[0] + m.last * a2[0]) + a.dot(m.deflection * B) +
         m.rotary * (spin + m.mean_rotation.dot(second));
  return f;
}

namespace {

/// df/dz: through a (A and B), and through beta, with which e and n rotate.
SevenSquare by_place(const Moments& m, const Chord& chord, const Rates& rates) {
  const auto a1 = rates.acceleration.head<2>(), a2 = rates.acceleration.segment<2>(2);
  const auto& a = chord.local;
  const Eigen::Vector2d rate = rates.velocity.segment<2>(4), second = rates.acceleration.segment<2>(4);
  const double b = rates.velocity[6], spin = rates.acceleration[6];
  const Eigen::Vector2d A = second - b * b * a, B = 2 * b * rate + spin * a;
  SevenSquare K = SevenSquare::Zero();
  K.block<1, 2>(0, 4) = -spin * m.first.transpose();
  K.block<1, 2>(1, 4) = -b * b * m.first.transpose();
  K.block<1, 2>(2, 4) = -spin * m.last.transpose();
  K.block<1, 2>(3, 4) = -b * b * m.last.transpose();
  K.block<2, 2>(4, 4) = -b * b * m.deflection;
  K.block<1, 2>(6, 4) = (m.deflection * (B + spin * a) - m.first * a1[0] - m.last * a2[0]).transpose();
  K(0, 6) = -m.first.dot(A);
  K(1, 6) = -m.first.dot(B);
  K(2, 6) = -m.last.dot(A);
  K(3, 6) = -m.last.dot(B);
  K.block<2, 1>(4, 6) = -m.first * a1[0] - m.last * a2[0];
  K(6, 6) = -a.dot(m.first * a1[1] + m.last * a2[1]);
  return K;
}

/// df/dz.: gyroscopic and centrifugal.
SevenSquare by_velocity(const Moments& m, const Chord& chord, const Seven& velocity) {
  const auto& a = chord.local;
  const Eigen::Vector2d rate = velocity.segment<2>(4), moved = m.deflection * a;
  const double b = velocity[6];
  SevenSquare C = SevenSquare::Zero();
  C.block<1, 2>(0, 4) = -2 * b * m.first.transpose();
  C.block<1, 2>(2, 4) = -2 * b * m.last.transpose();
  C.block<1, 2>(6, 4) = 2 * b * moved.transpose();
  C(0, 6) = -2 * m.first.dot(rate);
  C(1, 6) = -2 * b * m.first.dot(a);
  C(2, 6) = -2 * m.last.dot(rate);
  C(3, 6) = -2 * b * m.last.dot(a);
  C.block<2, 1>(4, 6) = -2 * b * moved;
  C(6, 6) = 2 * moved.dot(rate);
  return C;
}

/// df/dz..: the mass matrix, symmetric.
SevenSquare by_acceleration(const Moments& m, const Chord& chord) {
  const auto& a = chord.local;
  SevenSquare M = SevenSquare::Zero();
  M.diagonal().head<4>().setConstant(m.mass / 3);
  M(0, 2) = M(1, 3) = M(2, 0) = M(3, 1) = m.mass / 6;
  M.block<2, 1>(4, 1) = m.first;
  M.block<2, 1>(4, 3) = m.last;
  M.block<1, 2>(1, 4) = m.first.transpose();
  M.block<1, 2>(3, 4) = m.last.transpose();
  M.block<2, 2>(4, 4) = m.deflection + m.rotary * m.rotation;
  M.block<2, 1>(4, 6) = m.rotary * m.mean_rotation;
  M.block<1, 2>(6, 4) = m.rotary * m.mean_rotation.transpose();
  M(0, 6) = M(6, 0) = -m.first.dot(a);
  M(2, 6) = M(6, 2) = -m.last.dot(a);
  M(6, 6) = a.dot(m.deflection * a) + m.rotary;
  return M;
}

}  // namespace

ForceTangent inertia_tangent(const Moments& m, const Chord& chord, const Rates& rates) {
  return {by_place(m, chord, rates), by_velocity(m, chord, rates.velocity), by_acceleration(m, chord)};
}

}  // namespace floe::reference::corotational
