#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "floe/dynamics/start.h"
#include "floe/petsc/factorisation.h"
#include "floe/petsc/values.h"
#include "relaxation.h"
#include "resolution.h"
#include "round_off.h"
#include "turns.h"
#include "undetermined.h"

namespace floe::dynamics {

using petsc::check;

namespace {

struct EquilibriumContext {
  const System& system;
  double t;
  Vec V, A;
  petsc::Guard guard;
};

PetscErrorCode equilibrium_residual(SNES, Vec U, Vec F, void* context) {
  auto& c = *static_cast<EquilibriumContext*>(context);
  return c.guard.run([&] { c.system.residual(c.t, U, c.V, c.A, ConstraintLevel::position, F); });
}

PetscErrorCode equilibrium_tangent(SNES, Vec U, Mat J, Mat, void* context) {
  auto& c = *static_cast<EquilibriumContext*>(context);
  return c.guard.run([&] { c.system.tangent(c.t, U, c.V, c.A, {1, 0, 0}, J); });
}

/// Null vectors of the static tangent.
Undetermined open_directions(const System& system, double t, Vec U, Vec V) {
  const petsc::VecHandle A = system.create_vector();
  const petsc::MatHandle J = system.create_tangent();
  system.tangent(t, U, V, A, {1, 0, 0}, J);
  return null_vectors(system, J);
}

std::string none_at(double t, const std::string& why) {
  return fmt::format("no equilibrium at t = {:.6g}; {}", t, why);
}

NothingHolds unheld(double t, const std::string& bodies) {
  return NothingHolds(none_at(
      t, fmt::format("nothing holds the configuration in some direction{}, or so little that it is round-off of what "
                     "holds the rest; start from another one (`initial`)",
                     bodies)));
}

NothingHolds driven_away(double t, const std::string& bodies) {
  return NothingHolds(none_at(t, fmt::format("nothing holds the configuration in some direction{}, and the loads drive "
                                             "it on that way without end; hold it, or start from another one "
                                             "(`initial`)",
                                             bodies)));
}

/// |U|, and where frames could be: turned by 1 rad and moved by their radii. Where joints meet is known to eps of that.
petsc::VecHandle sizes_of_places(const System& system, const std::vector<FrameInertia>& frames, Vec U) {
  petsc::VecHandle all = system.create_vector();
  check(VecCopy(U, all));
  check(VecAbs(all));
  petsc::Values own(all);
  for (const FrameInertia& frame : frames) {
    const int first = frame.first, dimension = static_cast<int>(frame.lever.rows());
    for (int local = first; local < frame.turns + frame.lever.cols(); ++local) {
      double& size = own[system.coordinates().global()[local]];
      size = std::max(size, local < first + dimension ? frame.radius : 1.0);
    }
  }
  return all;
}

/// Whether nothing but round-off is left of forces and of where joints meet.
bool is_at_rest(const System& system, double t, Vec U, Vec V) {
  const petsc::VecHandle A = system.create_vector(), F = system.create_vector();
  const petsc::MatHandle J = system.create_tangent();
  const petsc::VecHandle sizes = sizes_of_places(system, frame_inertias(system, t, U, V, J), U);
  system.residual(t, U, V, A, ConstraintLevel::position, F);
  system.tangent(t, U, V, A, {1, 0, 0}, J);
  return is_round_off(J, sizes, F, 4);
}

/// Refuses what no search can find, and relaxes what nothing holds as it stands. @return  steps
PetscInt prepare_search(const System& system, double t, Vec U, Vec V) {
  const Undetermined open = open_directions(system, t, U, V);
  if (!open.any()) return 0;
  if (open.repeated)
    throw RunError(none_at(t, fmt::format("constraints repeat one another{}: leave out one of these joints, or let it "
                                          "hold less",
                                          open.joints)));
  if (is_at_rest(system, t, U, V)) throw unheld(t, open.bodies);  // round-off must not set it going
  const petsc::VecHandle before = system.create_vector();
  check(VecCopy(U, before));
  const Relaxation relaxed = relax(system, t, U, V);
  if (!relaxed.runs_away && !open_directions(system, t, U, V).any()) return relaxed.steps;
  check(VecCopy(before, U));
  if (relaxed.runs_away) throw driven_away(t, open.bodies);
  throw unheld(t, open.bodies);
}

/// As SNES does it, or where nothing but round-off is left of any row (rows have units of their own, so that no norm of
/// them all tells): a search may begin there, or arrive because some forces are stiff beside the rest. What it arrives
/// at is looked at by make_sure.
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
    if (is_round_off(J, U, F, iteration == 0 ? 4 : 256)) *reason = SNES_CONVERGED_FNORM_ABS;
  });
}

constexpr double open_limit = 1e-6;
constexpr int most_corrections = 20;

/// A dense LU overwrites its matrix: a copy of a dense one, nothing for a sparse one.
petsc::MatHandle copy_of_dense(Mat J) {
  petsc::MatHandle copy;
  PetscBool dense = PETSC_FALSE;
  check(PetscObjectTypeCompareAny(reinterpret_cast<PetscObject>(J), &dense, MATSEQDENSE, MATDENSE, ""));
  if (dense) check(MatDuplicate(J, MAT_COPY_VALUES, copy.out()));
  return copy;
}

/// J^-1 F into `step`. @return  false where there is none
bool correct(KSP ksp, Vec F, Vec step) {
  try {
    check(KSPSolve(ksp, F, step));
  } catch (const petsc::Error& error) {
    if (!is_singular(error.code())) throw;
    if (const petsc::FactorFault fault = petsc::factor_fault(ksp); !fault.text.empty() && !fault.singular)
      throw RunError(fault.text);
    return false;
  }
  KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
  double size = 0;
  check(KSPGetConvergedReason(ksp, &reason));
  check(VecNorm(step, NORM_INFINITY, &size));
  return reason >= 0 && std::isfinite(size);
}

/// Where the search ended, no norm of the forces bounds the error of the configuration: stiff rows may hide what a soft
/// direction lacks, and the last step came from a tangent that forces on the way there stiffened. What tells is the
/// next step, by the tangent of this configuration. Steps are taken until one is short in every direction and neither
/// what it changes of the tangent nor the tangent's round-off matters.
///
/// @return  steps that were needed before the one that told. @throws  NothingHolds: the tangent is round-off in some
/// direction; LostInRoundOff
PetscInt make_sure(const System& system, double t, Vec U, Vec V, Vec before, Mat J) {
  const petsc::VecHandle A = system.create_vector(), F = system.create_vector(), step = system.create_vector();
  petsc::MatHandle next;
  double open = 0, gain = 0, force = 0;
  for (PetscInt done = 0; done < most_corrections; ++done) {
    system.residual(t, U, V, A, ConstraintLevel::position, F);
    check(VecNorm(F, NORM_INFINITY, &force));
    if (force == 0) return done;
    const std::vector<FrameInertia> frames = frame_inertias(system, t, U, V, J);
    system.tangent(t, U, V, A, {1, 0, 0}, J);
    const petsc::MatHandle copy = copy_of_dense(J);
    const Mat kept = copy ? copy.get() : J;
    const petsc::KspHandle ksp = tangent_solver(J, "static_");
    if (!correct(ksp, F, step)) throw unheld(t, null_vectors(system, kept).bodies);
    open = plain_size(system, frames, kept, step, U, before);
    check(VecAXPY(U, -1, step));
    if (open > open_limit && done + 1 < most_corrections) continue;
    if (!next) next = system.create_tangent();
    system.tangent(t, U, V, A, {1, 0, 0}, next);
    gain = gain_of_errors(system, ksp, kept, next);
    if (open <= open_limit && gain < 0.5) return done;
  }
  if (!(gain < 0.5)) throw unheld(t, names_of_movers(system, step));
  if (open > 1e-2)  // round-off leaves no more than that where the gain is small: smaller steps of the loads may help
    throw RunError(
        fmt::format("no equilibrium at t = {:.6g}: further steps of Newton's method do not become short (the "
                    "last is {:.2g} of the configuration)",
                    t, open));
  throw LostInRoundOff(
      fmt::format("no equilibrium at t = {:.6g}: round-off of the greatest forces leaves {:.2g} of the configuration "
                  "open (limit {:.0e}); stiffnesses, or the sides of cells, differ too much for double precision",
                  t, open, open_limit));
}

/// Where Newton's method fails: whether that is because the loads drive it away on a path without any stiffness.
void look_for_mechanism(const System& system, double t, Vec before, Vec V) {
  const petsc::VecHandle U = system.create_vector();
  check(VecCopy(before, U));
  const Relaxation relaxed = relax(system, t, U, V);
  if (relaxed.freely) throw driven_away(t, relaxed.bodies);
}

/// @throws RunError  joints are met otherwise than they are meant to be, or a body turned too far. Collective.
void check_place(const System& system, double t, Vec before, Vec U, Vec V) {
  const System::Astray astray = system.astray(t, U);
  if (!astray.joint.empty()) throw RunError(fmt::format("no equilibrium at t = {:.6g}: {}", t, astray.text()));
  const double turn = greatest_turn(system, before, U);
  if (turn < 1.2 * M_PI) return;
  look_for_mechanism(system, t, before, V);
  throw RunError(fmt::format(
      "no equilibrium at t = {:.6g} within half a turn: Newton's method turns a body by {:.3g} rad", t, turn));
}

}  // namespace

PetscInt equilibrium(const System& system, double t, Vec U, Vec V) {
  const petsc::VecHandle before = system.create_vector();
  check(VecCopy(U, before));
  const PetscInt relaxed = prepare_search(system, t, U, V);
  const petsc::VecHandle A = system.create_vector(), F = system.create_vector();
  const petsc::MatHandle J = system.create_tangent();
  EquilibriumContext context{system, t, V, A, {}};
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
  const petsc::FactorFault fault = petsc::factor_fault(ksp);
  SNESConvergedReason reason = SNES_CONVERGED_ITERATING;
  PetscInt iterations = 0;
  check(SNESGetConvergedReason(snes, &reason));
  check(SNESGetIterationNumber(snes, &iterations));
  snes.out();  // its factor is not needed beside the next
  if (!why.empty() || reason < 0) {
    look_for_mechanism(system, t, before, V);
    if (!fault.text.empty() && !fault.singular) throw RunError(fault.text);
    if (why.empty()) why = SNESConvergedReasons[reason];
    throw RunError(fmt::format("no equilibrium at t = {:.6g} (options -static_snes_...): {} after {} iterations", t,
                               why, iterations));
  }
  check_place(system, t, before, U, V);  // where joints are met otherwise, no more steps are of use
  const PetscInt corrections = make_sure(system, t, U, V, before, J);
  check_place(system, t, before, U, V);
  return relaxed + iterations + corrections;
}

}  // namespace floe::dynamics
