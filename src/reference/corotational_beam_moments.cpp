#include "corotational_beam_forces.h"

namespace floe::reference::corotational {

Moments moments(double l, const CorotationalBeam::Properties& properties) {
  const auto [EA, EI, rhoA, rhoI, viscosity] = properties;
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
  return m;
}

}  // namespace floe::reference::corotational
