#include "equilibrium_newton.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "floe/petsc/factorisation.h"
#include "floe/petsc/options.h"
#include "floe/petsc/values.h"
#include "floe/solve/start.h"
#include "resolution.h"
#include "rotations.h"
#include "round_off.h"

namespace floe::solve {

using petsc::check;

namespace {

/// Norms of the last ten iterates.
struct Recent {
  std::vector<double> values;
  void add(double value) {
    values.push_back(value);
    if (values.size() > 10) values.erase(values.begin());
  }
  /// None of ten is less than a tenth of another.
  bool stands() const {
    const auto [least, greatest] = std::minmax_element(values.begin(), values.end());
    return values.size() == 10 && *least > 0.1 * *greatest;
  }
};

struct Context {
  const System& system;
  double t;
  Vec V, A, before, places;
  Mat terms;  ///< for the tangent whose terms are looked at; where null, SNES's own does
  Recent residuals, steps;
  bool far = false, too_far = false, stands = false;
  petsc::Guard guard;
};

PetscErrorCode residual(SNES, Vec U, Vec F, void* context) {
  auto& c = *static_cast<Context*>(context);
  return c.guard.run([&] { c.system.residual(c.t, U, c.V, c.A, ConstraintLevel::position, F); });
}

PetscErrorCode tangent(SNES, Vec U, Mat J, Mat, void* context) {
  auto& c = *static_cast<Context*>(context);
  return c.guard.run([&] { c.system.tangent(c.t, U, c.V, c.A, {1, 0, 0}, J); });
}

/// Whether the forces at U are round-off of their terms, by the tangent here or one step before.
bool is_round_off_here(Context& c, SNES snes, PetscInt iteration) {
  Vec U = nullptr, F = nullptr;
  Mat J = c.terms;
  check(SNESGetSolution(snes, &U));
  check(SNESGetFunction(snes, &F, nullptr, nullptr));
  if (!J) check(SNESGetJacobian(snes, &J, nullptr, nullptr, nullptr));
  if (c.terms || iteration == 0) c.system.tangent(c.t, U, c.V, c.A, {1, 0, 0}, J);
  const petsc::VecHandle sizes = c.system.create_vector();
  check(VecCopy(U, sizes));
  check(VecAbs(sizes));
  check(VecPointwiseMax(sizes, sizes, c.places));
  return is_round_off(J, sizes, F, iteration == 0 ? 4 : 256);
}

void look_at_step(Context& c, SNES snes) {
  Vec U = nullptr, step = nullptr;
  check(SNESGetSolution(snes, &U));
  check(SNESGetSolutionUpdate(snes, &step));
  c.far = c.far || max_rotation_of_step(c.system, step) > M_PI / 2;
  c.too_far = max_rotation(c.system, c.before, U) > rotation_limit;
}

PetscErrorCode converged(SNES snes, PetscInt iteration, PetscReal size, PetscReal step, PetscReal norm,
                         SNESConvergedReason* reason, void* context) {
  auto& c = *static_cast<Context*>(context);
  const PetscErrorCode code = SNESConvergedDefault(snes, iteration, size, step, norm, reason, nullptr);
  if (code || *reason < 0) return code;
  return c.guard.run([&] {
    if (iteration > 0) look_at_step(c, snes);
    c.residuals.add(norm);
    if (iteration > 0) c.steps.add(step);
    if (c.too_far)
      *reason = SNES_DIVERGED_DTOL;
    else if (*reason == SNES_CONVERGED_ITERATING && iteration != 1 && iteration != 2 &&
             is_round_off_here(c, snes, iteration))
      *reason = SNES_CONVERGED_FNORM_ABS;
    else if (*reason == SNES_CONVERGED_ITERATING && c.residuals.stands() && c.steps.stands())
      c.stands = true, *reason = SNES_DIVERGED_LOCAL_MIN;
  });
}

/// Solves; what keeps a linear solver from its factor but is not the search's fault is thrown.
void solve(SNES snes, Vec U, Context& context, NewtonSearch& search) {
  try {
    context.guard.check(SNESSolve(snes, nullptr, U));
  } catch (const petsc::Error& error) {
    if (!is_singular(error.code())) throw;
    search.singular = true;
  }
  KSP ksp = nullptr;
  SNESConvergedReason reason = SNES_CONVERGED_ITERATING;
  check(SNESGetKSP(snes, &ksp));
  check(SNESGetConvergedReason(snes, &reason));
  check(SNESGetIterationNumber(snes, &search.iterations));
  const petsc::FactorFault fault = petsc::factor_fault(ksp);
  if (!fault.text.empty() && !fault.singular) throw RunError(fault.text);
  search.singular = search.singular || fault.singular;
  search.far = context.far;
  if (context.too_far)
    search.fault = "Newton's method rotates a body by more than 180 deg";
  else if (search.singular || (reason < 0 && !context.stands && reason != SNES_DIVERGED_MAX_IT))
    search.fault = fmt::format("{} after {} iterations (options -static_snes_...)",
                               search.singular ? "singular tangent" : SNESConvergedReasons[reason], search.iterations);
}

}  // namespace

NewtonSearch newton(const System& system, double t, Vec U, Vec V, Vec before, Mat J) {
  const petsc::VecHandle A = system.create_vector(), F = system.create_vector(), nothing = system.create_vector();
  const petsc::VecHandle places = sizes_of_places(system, frame_inertias(system, t, U, V, J), nothing);
  const petsc::MatHandle terms = copy_of_dense(J);
  Context context{system, t, V, A, before, places, terms ? terms.get() : nullptr, {}, {}, false, false, false, {}};
  petsc::SnesHandle snes;
  KSP ksp = nullptr;
  SNESLineSearch steps = nullptr;
  check(SNESCreate(system.comm(), snes.out()));
  check(SNESSetOptionsPrefix(snes, "static_"));
  check(SNESSetFunction(snes, F, residual, &context));
  check(SNESSetJacobian(snes, J, J, tangent, &context));
  check(SNESSetTolerances(snes, 0, 1e-11, 1e-11, 100, 10000));
  check(SNESSetConvergenceTest(snes, converged, &context, nullptr));
  check(SNESSetDivergenceTolerance(snes, -1));  // the first step stretches slender bodies by (L/r)^2
  check(SNESGetLineSearch(snes, &steps));
  check(SNESLineSearchSetType(steps, SNESLINESEARCHBASIC));
  check(SNESGetKSP(snes, &ksp));
  set_tangent_solver(ksp, J);
  petsc::check_options(SNESSetFromOptions(snes), "static_");
  petsc::refuse_preconditioner_alone(ksp);
  NewtonSearch search;
  solve(snes, U, context, search);
  return search;
}

}  // namespace floe::solve
