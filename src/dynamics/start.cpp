#include "floe/dynamics/start.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "at_base.h"
#include "floe/petsc/factorisation.h"
#include "floe/petsc/values.h"
#include "round_off.h"
#include "undetermined.h"

namespace floe::dynamics {

using petsc::check;

void set_tangent_solver(KSP ksp, Mat J) {
  PC pc = nullptr;
  PetscBool dense = PETSC_FALSE;
  check(PetscObjectTypeCompareAny(reinterpret_cast<PetscObject>(J), &dense, MATSEQDENSE, MATDENSE, ""));
  check(KSPSetType(ksp, KSPPREONLY));
  check(KSPGetPC(ksp, &pc));
  check(PCSetType(pc, PCLU));
  if (!dense) check(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
}

petsc::KspHandle tangent_solver(Mat J, const char* prefix) {
  petsc::KspHandle ksp;
  check(KSPCreate(PetscObjectComm(reinterpret_cast<PetscObject>(J)), ksp.out()));
  check(KSPSetOptionsPrefix(ksp, prefix));
  check(KSPSetOperators(ksp, J, J));
  set_tangent_solver(ksp, J);
  petsc::check_options(KSPSetFromOptions(ksp), prefix);
  return ksp;
}

bool is_singular(PetscErrorCode code) {
  return code == PETSC_ERR_MAT_LU_ZRPVT || code == PETSC_ERR_NOT_CONVERGED || code == PETSC_ERR_LIB;
}

namespace {

/// Symmetric scaling of [M C'; C 0]: 1 / sqrt(M_ii) for coordinates, 1 / |row of C M^(-1/2)| for multipliers. Scales J.
petsc::VecHandle equilibrate(const System& system, Mat J) {
  const auto& multipliers = system.coordinates().owned_multipliers();
  petsc::VecHandle scale = system.create_vector();
  check(MatGetDiagonal(J, scale));
  {
    petsc::Values s(scale);
    for (PetscInt i = s.first; i < s.end; ++i) s[i] = s[i] != 0 ? 1 / std::sqrt(std::abs(s[i])) : 1;
    for (PetscInt row : multipliers) s[row] = 1;
  }
  check(MatDiagonalScale(J, nullptr, scale));
  const petsc::VecHandle columns = system.create_vector();
  check(VecSet(columns, 1));
  {
    petsc::Values s(scale), c(columns);
    for (PetscInt row : multipliers) {
      PetscInt count = 0;
      const PetscInt* where = nullptr;
      const double* entries = nullptr;
      check(MatGetRow(J, row, &count, &where, &entries));
      const double norm = Eigen::Map<const Eigen::VectorXd>(entries, count).norm();
      check(MatRestoreRow(J, row, &count, &where, &entries));
      s[row] = c[row] = norm > 0 ? 1 / norm : 1;
    }
  }
  check(MatDiagonalScale(J, scale, columns));
  return scale;
}

/// x with [M C'; C 0] x = b.
petsc::VecHandle solve_saddle(const System& system, double t, Vec U, Vec V, Vec A, Vec b) {
  const petsc::MatHandle J = system.create_tangent();
  system.tangent(t, U, V, A, {0, 0, 1}, J);
  const petsc::VecHandle scale = equilibrate(system, J);
  const petsc::VecHandle right = system.create_vector(), product = system.create_vector();
  petsc::VecHandle x = system.create_vector();
  check(VecPointwiseMult(right, b, scale));
  petsc::MatHandle kept;  // a dense LU overwrites its matrix
  check(MatDuplicate(J, MAT_COPY_VALUES, kept.out()));
  const petsc::KspHandle ksp = tangent_solver(J, "motion_start_");
  std::string raised;
  try {
    check(KSPSolve(ksp, right, x));
  } catch (const petsc::Error& error) {
    raised = error.what();
    if (!is_singular(error.code())) throw RunError(raised);
  }
  if (const petsc::FactorFault fault = petsc::factor_fault(ksp); !fault.text.empty() && !fault.singular)
    throw RunError(fault.text);
  if (!raised.empty()) throw RunError(singular_start + undetermined(system, kept));
  KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
  double size = 0, residual = 0, given = 0;
  check(KSPGetConvergedReason(ksp, &reason));
  check(VecNorm(x, NORM_INFINITY, &size));
  check(MatMult(kept, x, product));
  check(VecAXPY(product, -1, right));
  check(VecNorm(product, NORM_INFINITY, &residual));
  check(VecNorm(right, NORM_INFINITY, &given));
  if (reason < 0 || !std::isfinite(size) || !(residual <= 1e-6 * given))
    throw RunError(singular_start + undetermined(system, kept));
  check(VecPointwiseMult(x, x, scale));
  return x;
}

/// Splits a solution of the saddle: accelerations (multipliers zero) and multipliers (into U).
void split(const System& system, Vec x, Vec U, Vec A) {
  check(VecCopy(x, A));
  petsc::Values from(x), a(A);
  for (PetscInt row : system.coordinates().owned_multipliers()) a[row] = 0;
  if (!U) return;
  petsc::Values u(U);
  for (PetscInt row : system.coordinates().owned_multipliers()) u[row] = from[row];
}

/// Keeps only the multiplier rows (`multipliers`), or only the others.
void keep_rows(const System& system, Vec f, bool multipliers) {
  petsc::Values values(f);
  const auto& rows = system.coordinates().owned_multipliers();  // ascending
  auto next = rows.begin();
  for (PetscInt i = values.first; i < values.end; ++i) {
    const bool is = next != rows.end() && *next == i;
    if (is) ++next;
    if (is != multipliers) values[i] = 0;
  }
}

}  // namespace

void consistent_start(const System& system, double t, Vec U, Vec V, Vec A) {
  const AtBase at_base(system, U);
  keep_rows(system, U, false);
  check(VecSet(A, 0));
  const petsc::VecHandle F = system.create_vector();
  system.residual(t, U, V, A, ConstraintLevel::acceleration, F);
  check(VecScale(F, -1));
  const petsc::VecHandle x = solve_saddle(system, t, U, V, A, F);
  split(system, x, U, A);
}

double consistent_velocities(const System& system, double t, Vec U, Vec V, Vec impulses) {
  if (impulses) check(VecSet(impulses, 0));
  if (system.coordinates().multiplier_count() == 0) return 0;
  const AtBase at_base(system, U);
  const petsc::VecHandle F = system.create_vector(), A = system.create_vector();
  system.residual(t, U, V, A, ConstraintLevel::velocity, F);
  keep_rows(system, F, true);
  check(VecScale(F, -1));
  double wrong = 0, size = 0, change = 0;
  check(VecNorm(F, NORM_INFINITY, &wrong));
  if (wrong == 0) return 0;
  const petsc::VecHandle x = solve_saddle(system, t, U, V, A, F);
  split(system, x, impulses, A);
  check(VecNorm(V, NORM_2, &size));
  check(VecNorm(A, NORM_2, &change));
  check(VecAXPY(V, 1, A));
  if (size > 0) return change / size;
  return wrong > 1e-12 ? 1 : 0;  // bodies at rest, and drives whose rates are round-off: nothing to tell of
}

double constraint_violation(const System& system, double t, Vec U, Vec V, ConstraintLevel level) {
  return system.constraint_violation(t, U, V, level);
}

namespace {

struct EquilibriumContext {
  const System& system;
  double t;
  Vec V, A;
  petsc::Guard guard;
  double open = 0;  ///< where nothing but round-off is left of the forces: the last step's share of the configuration
};

PetscErrorCode equilibrium_residual(SNES, Vec U, Vec F, void* context) {
  auto& c = *static_cast<EquilibriumContext*>(context);
  return c.guard.run([&] { c.system.residual(c.t, U, c.V, c.A, ConstraintLevel::position, F); });
}

PetscErrorCode equilibrium_tangent(SNES, Vec U, Mat J, Mat, void* context) {
  auto& c = *static_cast<EquilibriumContext*>(context);
  return c.guard.run([&] { c.system.tangent(c.t, U, c.V, c.A, {1, 0, 0}, J); });
}

/// Greatest turn of an attitude from one configuration to another with the same bases, as Newton's steps added up.
/// [rad]
double greatest_turn(const System& system, Vec from, Vec to) {
  Eigen::VectorXd before, after;
  system.gather(from, before), system.gather(to, after);
  double greatest = 0;
  for (const auto& attitude : system.attitudes())
    greatest = std::max(greatest, (after - before).segment<3>(attitude.first).norm());
  return greatest;
}

/// Null vectors of the static tangent.
Undetermined open_directions(const System& system, double t, Vec U, Vec V) {
  const petsc::VecHandle A = system.create_vector();
  const petsc::MatHandle J = system.create_tangent();
  system.tangent(t, U, V, A, {1, 0, 0}, J);
  return null_vectors(system, J);
}

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

/// U <- U - (K + s M)^-1 F, s = s_0, s_0/4, ... until it is nothing. Stops where a step fails. @return  steps
PetscInt relax(const System& system, double t, Vec U, Vec V) {
  const petsc::VecHandle A = system.create_vector(), F = system.create_vector(), step = system.create_vector();
  const petsc::MatHandle J = system.create_tangent();
  const double highest = first_shift(system, t, U, V);
  PetscInt steps = 0;
  for (double s = highest; s > 1e-14 * highest; s /= 4, ++steps) {
    system.residual(t, U, V, A, ConstraintLevel::position, F);
    system.tangent(t, U, V, A, {1, 0, s}, J);
    petsc::KspHandle ksp;
    double size = 0;
    check(KSPCreate(system.comm(), ksp.out()));
    check(KSPSetOperators(ksp, J, J));
    set_tangent_solver(ksp, J);
    try {
      check(KSPSolve(ksp, F, step));
    } catch (const petsc::Error& error) {
      if (!is_singular(error.code())) throw;
      return steps;
    }
    check(VecNorm(step, NORM_INFINITY, &size));
    if (!std::isfinite(size)) return steps;
    check(VecAXPY(U, -1, step));
  }
  return steps;
}

/// Refuses what no search can find, and relaxes what nothing holds as it stands. @return  steps
PetscInt prepare_search(const System& system, double t, Vec U, Vec V) {
  const auto fault = [&](const std::string& why) { return fmt::format("no equilibrium at t = {:.6g}; {}", t, why); };
  Undetermined open = open_directions(system, t, U, V);
  if (!open.any()) return 0;
  PetscInt steps = 0;
  if (!open.repeated) {
    const petsc::VecHandle before = system.create_vector();
    check(VecCopy(U, before));
    steps = relax(system, t, U, V);
    const Undetermined now = open_directions(system, t, U, V);
    if (!now.any()) return steps;
    check(VecCopy(before, U));
  }
  if (open.repeated)
    throw RunError(
        fault(fmt::format("constraints repeat one another{}: leave out one of these joints, or let it hold "
                          "less",
                          open.joints)));
  throw NothingHolds(fault(fmt::format(
      "nothing holds the configuration in some direction{}, or so little that it is round-off of what holds the rest; "
      "start from another one (`initial`)",
      open.bodies)));
}

constexpr double open_limit = 1e-6;

/// As SNES does it, or where nothing but round-off is left of any row (rows have units of their own, so that no norm of
/// them all tells): a search may begin there, or arrive because some forces are stiff beside the rest. Then the last
/// step is what another one would do, and too much of it is not accepted.
PetscErrorCode equilibrium_converged(SNES snes, PetscInt iteration, PetscReal size, PetscReal step, PetscReal residual,
                                     SNESConvergedReason* reason, void* context) {
  auto& c = *static_cast<EquilibriumContext*>(context);
  const PetscErrorCode code = SNESConvergedDefault(snes, iteration, size, step, residual, reason, nullptr);
  if (code || *reason != SNES_CONVERGED_ITERATING || iteration == 1 || iteration == 2) return code;
  return c.guard.run([&] {
    Vec U = nullptr, F = nullptr;
    check(SNESGetSolution(snes, &U));
    check(SNESGetFunction(snes, &F, nullptr, nullptr));
    const petsc::MatHandle J = c.system.create_tangent();
    c.system.tangent(c.t, U, c.V, c.A, {1, 0, 0}, J);
    if (!is_round_off(J, U, F, iteration == 0 ? 4 : 256)) return;
    if (iteration > 0) {
      Vec last = nullptr;
      check(SNESGetSolutionUpdate(snes, &last));
      c.open = share_of(J, last, U);
    }
    if (c.open <= open_limit)
      *reason = SNES_CONVERGED_FNORM_ABS;
    else if (iteration >= 10)
      *reason = SNES_DIVERGED_MAX_IT;
  });
}

}  // namespace

PetscInt equilibrium(const System& system, double t, Vec U, Vec V) {
  const petsc::VecHandle before = system.create_vector();
  check(VecCopy(U, before));
  const PetscInt relaxed = prepare_search(system, t, U, V);
  const petsc::VecHandle A = system.create_vector(), F = system.create_vector();
  const petsc::MatHandle J = system.create_tangent();
  EquilibriumContext context{system, t, V, A, {}, 0};
  petsc::SnesHandle snes;
  KSP ksp = nullptr;
  SNESLineSearch search = nullptr;
  check(SNESCreate(system.comm(), snes.out()));
  check(SNESSetOptionsPrefix(snes, "static_"));
  check(SNESSetFunction(snes, F, equilibrium_residual, &context));
  check(SNESSetJacobian(snes, J, J, equilibrium_tangent, &context));
  check(SNESSetTolerances(snes, 0, 1e-11, 1e-11, 100, 10000));
  check(SNESSetConvergenceTest(snes, equilibrium_converged, &context, nullptr));
  check(SNESSetDivergenceTolerance(snes, -1));  // the first step stretches slender bodies by (L/r)^2
  check(SNESGetLineSearch(snes, &search));
  check(SNESLineSearchSetType(search, SNESLINESEARCHBASIC));
  check(SNESGetKSP(snes, &ksp));
  set_tangent_solver(ksp, J);
  petsc::check_options(SNESSetFromOptions(snes), "static_");
  std::string why;
  try {
    context.guard.check(SNESSolve(snes, nullptr, U));
  } catch (const petsc::Error& error) {
    if (!is_singular(error.code())) throw;
    why = "singular tangent";
  }
  check(SNESGetKSP(snes, &ksp));
  if (const petsc::FactorFault fault = petsc::factor_fault(ksp); !fault.text.empty() && !fault.singular)
    throw RunError(fault.text);
  SNESConvergedReason reason = SNES_CONVERGED_ITERATING;
  PetscInt iterations = 0;
  check(SNESGetConvergedReason(snes, &reason));
  check(SNESGetIterationNumber(snes, &iterations));
  if (why.empty() && reason >= 0) {
    const System::Astray astray = system.astray(t, U);
    if (!astray.joint.empty()) throw RunError(fmt::format("no equilibrium at t = {:.6g}: {}", t, astray.text()));
    const double turn = greatest_turn(system, before, U);
    if (turn < 1.2 * M_PI) return relaxed + iterations;
    throw RunError(fmt::format(
        "no equilibrium at t = {:.6g} within half a turn: Newton's method turns a body by {:.3g} rad", t, turn));
  }
  if (why.empty() && context.open > open_limit)
    throw LostInRoundOff(
        fmt::format("no equilibrium at t = {:.6g}: round-off of the greatest forces leaves {:.2g} of the configuration "
                    "open (limit {:.0e}); stiffnesses, or the sides of cells, differ too much for double precision",
                    t, context.open, open_limit));
  if (why.empty()) why = SNESConvergedReasons[reason];
  throw RunError(fmt::format("no equilibrium at t = {:.6g} (options -static_snes_...): {} after {} iterations", t, why,
                             iterations));
}

}  // namespace floe::dynamics
