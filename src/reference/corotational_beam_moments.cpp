#include "corotational_beam_forces.h"

namespace floe::reference::corotational {

Moments moments(double l, const CorotationalBeam::Properties& properties) {
  const auto [EA, EI, rhoA, rhoI, viscosity, GA] = properties;
  Moments m;
  m.mass = rhoA * l;
  m.first = rhoA * l * l * Eigen::Vector2d(1. / 20, -1. / 30);
  m.last = rhoA * l * l * Eigen::Vector2d(1. / 30, -1. / 20);
  m.deflection << 1. / 105, -1. / 140, -1. / 140, 1. / 105;
  m.deflection *= rhoA * l * l * l;
  m.rotary = rhoI * l;
  m.slope << 2. / 15, -1. / 30, -1. / 30, 2. / 15;
  m.axial = EA / l;
  m.bending << 4, 2, 2, 4;
  m.bending *= EI / l;
  m.rotation = m.slope;
  m.mean_rotation.setZero();
  const double Phi = 12 * EI / (GA * l * l), c = Phi / (2 * (1 + Phi));
  if (Phi == 0) return m;
  const Eigen::Matrix2d T = Eigen::Matrix2d::Identity() - Eigen::Matrix2d::Constant(c);  // slopes of w by rotations
  m.mean_rotation.setConstant(c);
  m.first = (T * m.first).eval(), m.last = (T * m.last).eval();
  m.deflection = (T * m.deflection * T).eval();
  m.slope = (T * m.slope * T).eval();
  m.rotation = m.slope + m.mean_rotation * m.mean_rotation.transpose();
  m.bending = T * m.bending * T + GA * l * m.mean_rotation * m.mean_rotation.transpose();
  return m;
}

}  // namespace floe::reference::corotational
