#include "floe/solve/energy_balance.h"

#include <algorithm>
#include <cmath>

#include "at_base.h"
#include "floe/petsc/values.h"

namespace floe::solve {

using petsc::check;

namespace {

double total(const Energy& energy) { return energy.kinetic + energy.elastic + energy.potential; }

/// Rates of the multipliers are none.
petsc::VecHandle without_multipliers(const System& system, Vec rates) {
  petsc::VecHandle copy;
  check(VecDuplicate(rates, copy.out()));
  check(VecCopy(rates, copy));
  petsc::Values values(copy);
  for (PetscInt row : system.coordinates().owned_multipliers()) values[row] = 0;
  return copy;
}

struct Powers {
  double external, dissipated;  ///< P and P_d
};

Powers powers(const System& system, double t, double interval, Vec U, Vec V, Vec A) {
  const AtBase at_base(system, U, V, t);
  const petsc::VecHandle v = without_multipliers(system, V), a = without_multipliers(system, A);
  const petsc::VecHandle q = system.create_vector(), rate = system.create_vector(), F = system.create_vector();
  double rates = 0;
  for (const double e : {-interval, interval}) {
    check(VecWAXPY(q, e, v, U));
    check(VecWAXPY(rate, e, a, v));
    rates += total(system.energy(t + e, q, rate)) / (2 * e);
  }
  double unbalanced = 0, backward = 0;
  system.residual(t, U, V, A, ConstraintLevel::position, F);
  check(VecDot(F, v, &unbalanced));
  check(VecAXPBY(rate, -1, 0, V));
  system.residual(t, U, rate, A, ConstraintLevel::position, F);
  check(VecDot(F, v, &backward));
  return {rates - unbalanced, 0.5 * (unbalanced - backward)};
}

}  // namespace

void EnergyBalance::add(const System& system, double t, Vec U, Vec V, Vec A, double energy, double max_part) {
  if (count_ == 0) start_ = energy;
  const double h = t - t_;
  if (count_ > 0 && A && h > 0) {
    const auto [power, dissipated] = powers(system, t, 1e-3 * h, U, V, A);
    const double dissipation = std::max(0.0, dissipated);
    if (known_ == 0) power_ = power, dissipation_ = dissipation;
    const double external = work_ + dissipated_ + 0.5 * h * (power_ + dissipation_ + power + dissipation);
    const double lost = std::max(0.0, external - (energy - start_) - lost_in_impulses_);
    dissipated_ = std::min(dissipated_ + 0.5 * h * (dissipation_ + dissipation), lost);
    work_ = external - dissipated_;
    turnover_ += 0.5 * h * (std::abs(power_) + std::abs(power));
    level_ = energy - start_ - work_ - dissipated_;
    lowest_ = std::min(lowest_, level_);
    growth_ = std::max(growth_, level_ - lowest_);
    power_ = power, dissipation_ = dissipation, known_ = 1;
  }
  const double exchanged = std::max(turnover_, max_part);
  if (growth() <= 0.5 * exchanged) accounted_ = exchanged;
  beyond_ = growth() > most_growth * accounted_ ? beyond_ + 1 : 0;
  ++count_, t_ = t;
}

void EnergyBalance::pass_event(double gained, double lost, double damped, double released) {
  if (count_ == 0) return;  // the energy of the start is that after it
  start_ += released;
  work_ += gained - damped, dissipated_ += damped, turnover_ += std::abs(gained), lost_in_impulses_ += lost;
  known_ = 0;
  lowest_ = level_;
}

std::array<double, EnergyBalance::numbers> EnergyBalance::save() const {
  return {count_,  t_,     known_,  power_,     dissipation_, start_,           work_, dissipated_, turnover_,
          growth_, level_, lowest_, accounted_, beyond_,      lost_in_impulses_};
}

void EnergyBalance::load(const std::array<double, numbers>& saved) {
  count_ = saved[0], t_ = saved[1], known_ = saved[2], power_ = saved[3], dissipation_ = saved[4];
  start_ = saved[5], work_ = saved[6], dissipated_ = saved[7], turnover_ = saved[8], growth_ = saved[9];
  level_ = saved[10], lowest_ = saved[11], accounted_ = saved[12], beyond_ = saved[13], lost_in_impulses_ = saved[14];
}

}  // namespace floe::solve
