#include "relaxation.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "floe/petsc/values.h"
#include "floe/solve/start.h"
#include "rotations.h"
#include "round_off.h"
#include "undetermined.h"

namespace floe::solve {
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

/// The step without its multipliers.
petsc::VecHandle motion_of(const System& system, Vec step) {
  petsc::VecHandle motion = system.create_vector();
  check(VecCopy(step, motion));
  petsc::Values by(motion);
  for (const PetscInt row : system.coordinates().owned_multipliers()) by[row] = 0;
  return motion;
}

/// w'(K + s M) w: not positive where the step w goes uphill.
double curvature(Mat J, Vec motion) {
  petsc::VecHandle Jw;
  double product = 0;
  check(VecDuplicate(motion, Jw.out()));
  check(MatMult(J, motion, Jw));
  check(VecDot(motion, Jw, &product));
  return product;
}

/// Sizes of the last steps: whether they grow, and how.
struct Growth {
  double last = 0, before = 0, greatest = 0, rotated = 0;
  int fourfold = 0;  ///< how many of the last steps were four times the one before
  int alike = 0;     ///< how many of the last steps were as long as the one before
  void add(double size, double rotation) {
    before = last, last = size, greatest = std::max(greatest, size), rotated += rotation;
    fourfold = std::abs(last / before - 4) < 0.5 ? fourfold + 1 : 0;  // a first one divides by nothing: none
    alike = std::abs(last / before - 1) < 0.05 ? alike + 1 : 0;
  }
  bool grows() const { return last > 2 * before && before > 0 && last == greatest; }
  bool goes_round() const { return rotated > 3 * M_PI; }
};

constexpr double far = 1, near = 0.25;  // rad
constexpr int most_tries = 300;

}  // namespace

Relaxation relax(const System& system, double t, Vec U, Vec V) {
  const petsc::VecHandle A = system.create_vector(), F = system.create_vector(), step = system.create_vector();
  const petsc::MatHandle J = system.create_tangent();
  const double highest = first_shift(system, t, U, V), least = 1e-14 * highest;
  Relaxation done;
  Growth growth;
  double s = highest, rotation = 0;
  const auto ended = [&] { return s <= least && (s <= 1e-10 * least || (rotation < 0.01 && !growth.grows())); };
  for (int tries = 0; tries < most_tries && !ended(); ++tries) {
    system.residual(t, U, V, A, ConstraintLevel::position, F);
    system.tangent(t, U, V, A, {1, 0, s}, J);
    const petsc::MatHandle copy = copy_of_dense(J);
    if (!solve(system, J, F, step)) break;
    const petsc::VecHandle motion = motion_of(system, step);
    double size = 0;
    check(VecNorm(motion, NORM_INFINITY, &size));
    rotation = max_rotation_of_step(system, step);
    // The first follows the drives.
    if (done.steps > 0 && s < highest && (rotation > far || !(curvature(copy ? copy.get() : J.get(), motion) >= 0))) {
      s *= 4, rotation = far;
      continue;
    }
    growth.add(size, done.steps > 0 ? rotation : 0);
    if (growth.grows() || growth.goes_round()) done.bodies = names_of_movers(system, step);
    check(VecAXPY(U, -1, step));
    ++done.steps;
    if (growth.goes_round()) break;
    if (rotation <= near) s /= 4;
  }
  done.freely = growth.goes_round() ? growth.alike >= 8 : growth.fourfold >= 3 && growth.grows();
  done.runs_away = growth.goes_round() || growth.grows();
  return done;
}

}  // namespace floe::solve
