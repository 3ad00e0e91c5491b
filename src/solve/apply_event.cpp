#include "apply_event.h"

#include "floe/solve/start.h"

namespace floe::solve {
namespace {

petsc::VecHandle copy_of(Vec V) {
  petsc::VecHandle copy;
  petsc::check(VecDuplicate(V, copy.out()));
  petsc::check(VecCopy(V, copy));
  return copy;
}

}  // namespace

EventReport apply_event(const System& system, const Event& event, double t, double h, Vec U, Vec V) {
  EventReport report{event.name, event.what, t};
  if (!event.constraint_switch) return report;
  report.switches = true;
  const double before = system.energy(t, U, V).kinetic;
  event.constraint_switch->closed = event.closes;
  system.commit_step(U, V, t);
  const petsc::VecHandle impulses = system.create_vector(), rates = copy_of(V);
  try {
    consistent_velocities(system, t, U, V, impulses);
  } catch (const RunError& error) {
    throw RunError("event " + event.name + " (" + event.what + "): " + error.what());
  }
  if (!event.closes) return report;
  report.lost = before - system.energy(t, U, V).kinetic;
  report.damped = damp_jump(system, t, h, U, rates, V, impulses);
  Eigen::VectorXd local;
  system.gather(impulses, local);
  for (int i = 0; i < event.rows; ++i) report.impulses.push_back(local[event.first_row + i]);
  return report;
}

EventReport pass(const System& system, const Kink& kink, double h, Vec U, Vec V) {
  EventReport report{kink.name, kink.what, 0.5 * (kink.before + kink.after)};
  const double before = system.energy(kink.after, U, V).kinetic;
  const petsc::VecHandle rates = copy_of(V);
  try {  // where they do not jump, too: what a step leaves of their error would come back in the multipliers
    consistent_velocities(system, kink.after, U, V);
  } catch (const RunError& error) {
    throw RunError(kink.what.empty() ? std::string(error.what()) : kink.name + " (" + kink.what + "): " + error.what());
  }
  if (kink.what.empty()) return report;
  damp_jump(system, kink.after, h, U, rates, V);
  report.work = system.energy(kink.after, U, V).kinetic - before;
  return report;
}

}  // namespace floe::solve
