#include "floe/reference/corotational_beam.h"

#include <cmath>
#include <set>

#include "corotational_beam_forces.h"
#include "floe/error.h"

namespace floe::reference {

using namespace corotational;

namespace {

void refuse_faults(const std::vector<int>& coordinates, double length, const CorotationalBeam::Properties& p,
                   const Eigen::Vector2d& gravity) {
  std::vector<std::string> faults;
  const auto refuse = [&](bool wrong, const std::string& what) {
    if (wrong) faults.push_back("corotational beam: " + what);
  };
  const auto positive = [](double x) { return std::isfinite(x) && x > 0; };
  refuse(std::set<int>(coordinates.begin(), coordinates.end()).size() != 6 || coordinates.size() != 6,
         "expected six different coordinates");
  refuse(!positive(length), "its two nodes coincide, or are not finite");
  refuse(!positive(p.EA), "expected EA > 0");
  refuse(!positive(p.EI), "expected EI > 0");
  refuse(!(p.GA > 0), "expected GA > 0");
  refuse(!positive(p.rhoA), "expected rhoA > 0");
  refuse(!positive(p.rhoI) && p.rhoI != 0, "expected rhoI >= 0");
  refuse(!(p.viscosity >= 0 && std::isfinite(p.viscosity)), "expected viscosity >= 0");
  refuse(!gravity.allFinite(), "gravity is not finite");
  if (!faults.empty()) throw InputError(faults);
}

/// Accelerations on (e, n), those of the nodes less gravity.
Six apparent(const Chord& chord, Six a, const Eigen::Vector2d& gravity) {
  a.head<2>() -= gravity;
  a.segment<2>(3) -= gravity;
  return on_chord(chord, a);
}

}  // namespace

CorotationalBeam::CorotationalBeam(std::vector<int> coordinates, Eigen::Vector2d X1, Eigen::Vector2d X2,
                                   Properties properties, Eigen::Vector2d gravity)
    : coordinates_(std::move(coordinates)),
      X1_(X1),
      chord_(X2 - X1),
      length_(chord_.norm()),
      properties_(properties),
      gravity_(gravity) {
  refuse_faults(coordinates_, length_, properties_, gravity_);
}

Eigen::Vector2d CorotationalBeam::gravity(double t) const {
  return changing_gravity ? Eigen::Vector2d(gravity_ + changing_gravity(t)) : gravity_;
}

void CorotationalBeam::residual(const dynamics::Motion& motion, Eigen::VectorXd& r) const {
  const Chord chord = chord_at(chord_, motion.q);
  const Six v = on_chord(chord, motion.v), a = apparent(chord, motion.a, gravity(motion.t));
  const Moments m = moments(length_, properties_);
  const Rates rates = extended_rates(chord, v, a);
  Seven f = elastic_force(m, length_, chord) + inertia_force(m, chord, rates);
  if (properties_.viscosity != 0) f += properties_.viscosity * viscous_force(m, length_, chord, rates.velocity);
  r += on_world(chord, reduced(chord, f));
}

void CorotationalBeam::tangent(const dynamics::Motion& motion, dynamics::Weights weights, Eigen::MatrixXd& J) const {
  const Chord chord = chord_at(chord_, motion.q);
  const Six v = on_chord(chord, motion.v), a = apparent(chord, motion.a, gravity(motion.t));
  const Moments m = moments(length_, properties_);
  const Rates rates = extended_rates(chord, v, a);
  Seven f = elastic_force(m, length_, chord) + inertia_force(m, chord, rates);
  ForceTangent by = inertia_tangent(m, chord, rates);
  by.K += elastic_stiffness(m, length_, chord);
  if (properties_.viscosity != 0) {
    f += properties_.viscosity * viscous_force(m, length_, chord, rates.velocity);
    add_viscous_tangent(m, length_, chord, rates.velocity, properties_.viscosity, by);
  }
  J += on_world(chord, reduced(chord, v, a, f, by.K, by.C, by.M, {weights.q, weights.v, weights.a}));
}

dynamics::Energy CorotationalBeam::energy(const dynamics::Motion& motion) const {
  const Chord chord = chord_at(chord_, motion.q);
  const Moments m = moments(length_, properties_);
  const Six v = on_chord(chord, motion.v);
  const Eigen::Vector2d middle = X1_ + motion.q.head<2>() + chord.length * chord.e / 2;
  const Eigen::Vector2d first_moment = m.mass * middle + chord.n * (m.first + m.last).dot(chord.local);
  return {kinetic_energy(m, chord, extended_rates(chord, v, Six::Zero()).velocity), elastic_energy(m, length_, chord),
          -gravity_.dot(first_moment)};
}

void CorotationalBeamMass::residual(const dynamics::Motion& motion, Eigen::VectorXd& r) const {
  const Chord chord = chord_at(chord_, motion.q);
  const Rates rates = extended_rates(chord, Six::Zero(), on_chord(chord, motion.a));
  r += on_world(chord, reduced(chord, inertia_force(moments(chord_.norm(), properties_), chord, rates)));
}

void CorotationalBeamMass::tangent(const dynamics::Motion& motion, dynamics::Weights weights,
                                   Eigen::MatrixXd& J) const {
  const Chord chord = chord_at(chord_, motion.q);
  const Six v = Six::Zero(), a = on_chord(chord, motion.a);
  const Moments m = moments(chord_.norm(), properties_);
  const Rates rates = extended_rates(chord, v, a);
  const ForceTangent by = inertia_tangent(m, chord, rates);
  J += on_world(
      chord, reduced(chord, v, a, inertia_force(m, chord, rates), by.K, by.C, by.M, {weights.q, weights.v, weights.a}));
}

}  // namespace floe::reference
