#include "relaxation.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "floe/dynamics/start.h"
#include "floe/petsc/values.h"
#include "turns.h"
#include "undetermined.h"

namespace floe::dynamics {
namespace {

using petsc::check;

/// The greatest K_ii / M_ii or |F_i| / M_ii: s with which a step is no longer than one.
double first_shift(const System& system, double t, Vec U, Vec V) {
  const petsc::VecHandle A = system.create_vector(), k = system.create_vector(), m = system.create_vector(),
                         F = system.create_vector();
  const petsc::MatHandle J = system.create_tangent();
  system.tangent(t, U, V, A, {1, 0, 0}, J);
  check(MatGetDiagonal(J, k));
  system.tangent(t, U, V, A, {0, 0, 1}, J);
  check(MatGetDiagonal(J, m));
  system.residual(t, U, V, A, ConstraintLevel::position, F);
  double highest = 0;
  {
    petsc::Values stiffness(k), mass(m), force(F);
    for (PetscInt i = mass.first; i < mass.end; ++i)
      if (mass[i] > 0) highest = std::max(highest, std::max(std::abs(stiffness[i]), std::abs(force[i])) / mass[i]);
  }
  MPI_Allreduce(MPI_IN_PLACE, &highest, 1, MPI_DOUBLE, MPI_MAX, system.comm());
  return highest;
}

/// (K + s M)^-1 F into `step`. @return  false where there is none
bool solve(const System& system, Mat J, Vec F, Vec step) {
  petsc::KspHandle ksp;
  double size = 0;
  check(KSPCreate(system.comm(), ksp.out()));
  check(KSPSetOperators(ksp, J, J));
  set_tangent_solver(ksp, J);
  try {
    check(KSPSolve(ksp, F, step));
  } catch (const petsc::Error& error) {
    if (!is_singular(error.code())) throw;
    return false;
  }
  check(VecNorm(step, NORM_INFINITY, &size));
  return std::isfinite(size);
}

/// Greatest entry among the coordinates, without the multipliers.
double moved_by(const System& system, Vec step) {
  double greatest = 0;
  {
    petsc::Values by(step);
    const auto& rows = system.coordinates().owned_multipliers();  // ascending
    auto next = rows.begin();
    for (PetscInt i = by.first; i < by.end; ++i) {
      if (next != rows.end() && *next == i)
        ++next;
      else
        greatest = std::max(greatest, std::abs(by[i]));
    }
  }
  MPI_Allreduce(MPI_IN_PLACE, &greatest, 1, MPI_DOUBLE, MPI_MAX, system.comm());
  return greatest;
}

/// Sizes of the last steps: whether they grow, and how.
struct Growth {
  double last = 0, before = 0, greatest = 0;
  int fourfold = 0;  ///< how many of the last steps were four times the one before
  void add(double size) {
    before = last, last = size, greatest = std::max(greatest, size);
    fourfold = std::abs(last / before - 4) < 0.5 ? fourfold + 1 : 0;  // a first one divides by nothing: none
  }
  bool grows() const { return last > 2 * before && before > 0 && last == greatest; }
};

}  // namespace

Relaxation relax(const System& system, double t, Vec U, Vec V) {
  const petsc::VecHandle A = system.create_vector(), F = system.create_vector(), step = system.create_vector();
  const petsc::MatHandle J = system.create_tangent();
  const double highest = first_shift(system, t, U, V);
  Relaxation done;
  Growth growth;
  for (double s = highest; s > 1e-14 * highest; s /= 4, ++done.steps) {
    system.residual(t, U, V, A, ConstraintLevel::position, F);
    system.tangent(t, U, V, A, {1, 0, s}, J);
    if (!solve(system, J, F, step)) break;
    growth.add(moved_by(system, step));
    const bool round = done.steps > 0 && turn_by(system, step) > 2 * M_PI;  // the first follows the drives
    if (round) done.runs_away = true;
    done.freely = growth.fourfold >= 3;
    if (round || growth.grows()) done.bodies = names_of_movers(system, step);
    if (round) return done;
    check(VecAXPY(U, -1, step));
  }
  done.runs_away = growth.grows();
  done.freely = done.freely && done.runs_away;
  return done;
}

}  // namespace floe::dynamics
