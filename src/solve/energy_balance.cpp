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

}  // namespace

double external_power(const System& system, double t, double interval, Vec U, Vec V, Vec A) {
  const AtBase at_base(system, U);
  const petsc::VecHandle v = without_multipliers(system, V), a = without_multipliers(system, A);
  const petsc::VecHandle q = system.create_vector(), rate = system.create_vector(), F = system.create_vector();
  double rates = 0;
  for (const double e : {-interval, interval}) {
    check(VecWAXPY(q, e, v, U));
    check(VecWAXPY(rate, e, a, v));
    rates += total(system.energy(t + e, q, rate)) / (2 * e);
  }
  system.residual(t, U, V, A, ConstraintLevel::position, F);
  double unbalanced = 0;
  check(VecDot(F, v, &unbalanced));
  return rates - unbalanced;
}

void EnergyBalance::add(const System& system, double t, Vec U, Vec V, Vec A, double energy, double max_part) {
  if (count_ == 0) start_ = energy;
  lowest_ = std::min(lowest_, energy);
  const double h = t - t_;
  if (count_ > 0 && A && h > 0) {
    const double power = external_power(system, t, 1e-3 * h, U, V, A), before = known_ != 0 ? power_ : power;
    work_ += 0.5 * h * (before + power);
    turnover_ += 0.5 * h * (std::abs(before) + std::abs(power));
    const double grown = energy - start_ - work_;
    growth_ = std::max(growth_, events_ > 0 ? std::min(grown, energy - lowest_) : grown);
    power_ = power, known_ = 1;
  }
  const double exchanged = std::max(turnover_, max_part);
  if (growth() <= 0.5 * exchanged) accounted_ = exchanged;
  beyond_ = growth() > most_growth * accounted_ ? beyond_ + 1 : 0;
  ++count_, t_ = t, energy_ = energy;
}

void EnergyBalance::pass_event(double energy) {
  work_ += energy, turnover_ += std::abs(energy);
  known_ = 0;
  energy_ += energy;  // several events may be at one instant
  lowest_ = energy_;
  ++events_;
}

std::array<double, EnergyBalance::numbers> EnergyBalance::save() const {
  return {count_,  t_,      power_,  known_,  start_,     work_,  turnover_,
          growth_, energy_, events_, lowest_, accounted_, beyond_};
}

void EnergyBalance::load(const std::array<double, numbers>& saved) {
  count_ = saved[0], t_ = saved[1], power_ = saved[2], known_ = saved[3];
  start_ = saved[4], work_ = saved[5], turnover_ = saved[6], growth_ = saved[7];
  energy_ = saved[8], events_ = saved[9], lowest_ = saved[10];
  accounted_ = saved[11], beyond_ = saved[12];
}

}  // namespace floe::solve
