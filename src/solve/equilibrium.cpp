#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>

#include "equilibrium_newton.h"
#include "floe/petsc/factorisation.h"
#include "floe/petsc/values.h"
#include "floe/solve/start.h"
#include "relaxation.h"
#include "resolution.h"
#include "rotations.h"
#include "round_off.h"
#include "undetermined.h"

namespace floe::solve {

using petsc::check;

namespace {

/// Null vectors of the static tangent.
Undetermined open_directions(const System& system, double t, Vec U, Vec V) {
  if (!can_look(system)) return {};
  const petsc::VecHandle A = system.create_vector();
  const petsc::MatHandle J = system.create_tangent();
  system.tangent(t, U, V, A, {1, 0, 0}, J);
  return null_vectors(system, J);
}

std::string none_at(double t, const std::string& why) {
  return fmt::format("no equilibrium at t = {:.6g}; {}", t, why);
}

Unconstrained unconstrained(double t, const std::string& bodies) {
  return Unconstrained(
      none_at(t, fmt::format("singular tangent stiffness{}: an unconstrained rigid-body motion, or ill-conditioning; "
                             "constrain it, or start from another configuration (`initial`)",
                             bodies)));
}

Unconstrained driven_away(double t, const std::string& bodies) {
  return Unconstrained(
      none_at(t, fmt::format("singular tangent stiffness{}: an unconstrained rigid-body motion, along which the loads "
                             "are not zero; constrain it, or start from another configuration (`initial`)",
                             bodies)));
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
    throw RunError(
        none_at(t, fmt::format("redundant constraints{}: remove one of these joints, or let it constrain fewer motions",
                               open.joints)));
  if (is_at_rest(system, t, U, V)) throw unconstrained(t, open.bodies);  // round-off must not set it going
  const petsc::VecHandle before = system.create_vector();
  check(VecCopy(U, before));
  const Relaxation relaxed = relax(system, t, U, V);
  if (!relaxed.runs_away && !open_directions(system, t, U, V).any()) return relaxed.steps;
  check(VecCopy(before, U));
  if (relaxed.runs_away) throw driven_away(t, open.bodies);
  throw unconstrained(t, open.bodies);
}

constexpr double open_limit = 1e-6;
constexpr int most_corrections = 20;

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
/// @return  steps that were needed before the one that told. @throws  Unconstrained: the tangent is round-off in some
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
    if (!correct(ksp, F, step)) throw unconstrained(t, null_vectors(system, kept).bodies);
    open = plain_size(system, frames, ksp, kept, step, U, before);
    check(VecAXPY(U, -1, step));
    if (open > open_limit && done + 1 < most_corrections) continue;
    if (!next) next = system.create_tangent();
    system.tangent(t, U, V, A, {1, 0, 0}, next);
    gain = gain_of_errors(system, ksp, kept, next);
    if (open <= open_limit && gain < 0.5) return done;
  }
  if (!(gain < 0.5)) throw unconstrained(t, names_of_movers(system, step));
  if (open > 1e-2)  // round-off leaves no more than that where the gain is small: smaller steps of the loads may help
    throw RunError(
        fmt::format("no equilibrium at t = {:.6g}: Newton's method does not converge (its last update is {:.2g} of the "
                    "configuration)",
                    t, open));
  throw LostInRoundOff(fmt::format(
      "no equilibrium at t = {:.6g}: round-off of the maximum forces leaves {:.2g} of the configuration undetermined "
      "(limit {:.0e}); stiffnesses, or the sides of elements, differ too much for double precision",
      t, open, open_limit));
}

/// @throws RunError  joints are met otherwise than they are meant to be, or a body rotated too far. Collective.
void check_place(const System& system, double t, Vec before, Vec U) {
  const System::FailedConstraint failed_constraint = system.failed_constraint(t, U);
  if (!failed_constraint.joint.empty()) throw RunError(none_at(t, failed_constraint.text()));
  if (const double rotation = max_rotation(system, before, U); rotation > rotation_limit)
    throw RunError(fmt::format(
        "no equilibrium at t = {:.6g} within a rotation of 180 deg: Newton's method rotates a body by {:.3g} rad", t,
        rotation));
}

/// Whether forces act at U and its tangent is indefinite.
bool goes_uphill(const System& system, double t, Vec U, Vec V) {
  return !is_at_rest(system, t, U, V) && unstable_directions(system, t, U, V).value_or(0) > 0;
}

/// From U to the equilibrium near it. `before`: where all began. @return  Newton's, with the corrections
NewtonSearch search_from(const System& system, double t, Vec U, Vec V, Vec before) {
  const petsc::MatHandle J = system.create_tangent();
  NewtonSearch search = newton(system, t, U, V, before, J);
  if (search.singular && search.iterations == 0) throw unconstrained(t, "");
  if (!search.fault.empty()) throw RunError(none_at(t, search.fault));
  check_place(system, t, before, U);  // where joints are met otherwise, no more steps are of use
  search.iterations += make_sure(system, t, U, V, before, J);
  check_place(system, t, before, U);
  return search;
}

/// Down from `before` as a damped motion would go, and from there to the equilibrium, into U.
/// @return  steps; none, and U as it was, where that way does not end
/// @throws Unconstrained  the loads drive it away; RunError  no equilibrium at its end
PetscInt search_below(const System& system, double t, Vec before, Vec U, Vec V) {
  const petsc::VecHandle below = system.create_vector();
  check(VecCopy(before, below));
  const Relaxation relaxed = relax(system, t, below, V);
  if (relaxed.freely) throw driven_away(t, relaxed.bodies);
  if (relaxed.runs_away || relaxed.steps == 0) return 0;
  check(VecCopy(below, U));
  return relaxed.steps + search_from(system, t, U, V, before).iterations;
}

}  // namespace

PetscInt equilibrium(const System& system, double t, Vec U, Vec V, bool descend) {
  const petsc::VecHandle before = system.create_vector();
  check(VecCopy(U, before));
  const PetscInt relaxed = prepare_search(system, t, U, V);
  std::exception_ptr fault;
  NewtonSearch found;
  try {
    found = search_from(system, t, U, V, before);
    if (!found.far && !(descend && goes_uphill(system, t, before, V))) return relaxed + found.iterations;
  } catch (const LostInRoundOff&) {
    throw;
  } catch (const RunError&) {
    fault = std::current_exception();
  }
  // Steps that rotate far may end at any equilibrium: the one below the start is meant.
  const petsc::VecHandle there = system.create_vector();
  check(VecCopy(U, there));
  try {
    if (const PetscInt steps = search_below(system, t, before, U, V); steps > 0) return relaxed + steps;
  } catch (const Unconstrained&) {
    if (fault) throw;
  } catch (const RunError&) {  // what Newton's method found, or said, stands
  }
  if (fault) std::rethrow_exception(fault);
  check(VecCopy(there, U));
  return relaxed + found.iterations;
}

}  // namespace floe::solve
