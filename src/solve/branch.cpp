#include "floe/solve/branch.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "floe/solve/start.h"
#include "mass_norm.h"

namespace floe::solve {

using petsc::check;

namespace {

/// J(at, U)^-1 F(other, U); null where the tangent is singular. Collective.
petsc::VecHandle step_towards(const System& system, double at, double other, Vec U, Vec V) {
  const petsc::VecHandle A = system.create_vector(), F = system.create_vector();
  petsc::VecHandle step = system.create_vector();
  const petsc::MatHandle J = system.create_tangent();
  double size = 0;
  system.residual(other, U, V, A, ConstraintLevel::position, F);
  system.tangent(at, U, V, A, {1, 0, 0}, J);
  const petsc::KspHandle ksp = tangent_solver(J, "static_");
  try {
    check(KSPSolve(ksp, F, step));
  } catch (const petsc::Error& error) {
    if (!is_singular(error.code())) throw;
    return {};
  }
  check(VecNorm(step, NORM_INFINITY, &size));
  if (!std::isfinite(size)) return {};
  return step;
}

/// Follows one step of the load.
class Follower {
 public:
  using Jumped = std::function<void(const BranchJump&, Vec, Vec)>;
  Follower(const System& system, double least, Vec U, Vec V, const Jumped& jumped)
      : system_(system), least_(least), U_(U), V_(V), jumped_(jumped) {}

  PetscInt go(double t, double next) {
    const petsc::VecHandle before = system_.create_vector();
    check(VecCopy(U_, before));
    PetscInt iterations = 0;
    try {
      iterations = equilibrium(system_, next, U_, V_);
    } catch (const Unconstrained&) {
      throw;
    } catch (const LostInRoundOff&) {
      throw;
    } catch (const RunError&) {
      check(VecCopy(before, U_));
      if (next - t < 2 * least_) throw;
      return halves(t, next);
    }
    const BranchJump jump = jump_of(t, before, next);
    if (jump.ratio > 0) return iterations + shorter(jump, before);
    system_.rebase(U_);
    return iterations;
  }

 private:
  PetscInt halves(double t, double next) {
    const PetscInt first = go(t, (t + next) / 2);
    return first + go((t + next) / 2, next);
  }

  /// The step once more in shorter ones, if there are; else it stands as it is.
  PetscInt shorter(const BranchJump& jump, Vec before) {
    const petsc::VecHandle found = system_.create_vector();
    std::vector<double> carried;
    check(VecCopy(U_, found));
    if (jump.to - jump.from >= 2 * least_) {
      system_.save(carried);
      check(VecCopy(before, U_));
      try {
        return halves(jump.from, jump.to);
      } catch (const RunError&) {  // none on the way: it was left
        system_.load(carried);
        check(VecCopy(found, U_));
      }
    }
    if (jump.ratio > least_jump) jumped_(jump, before, U_);
    system_.rebase(U_);
    return 0;
  }

  /// ratio 0: the branch continues, or nothing tells.
  BranchJump jump_of(double t, Vec before, double next) const {
    const petsc::VecHandle a = step_towards(system_, t, next, before, V_), b = step_towards(system_, next, t, U_, V_);
    if (!a.get() || !b.get()) return {};
    const petsc::VecHandle weights = root_masses(system_, next, U_, V_), change = system_.create_vector();
    check(VecCopy(U_, change));
    check(VecAXPY(change, -1, before));
    const double size = weighted_size(change, weights);
    const bool back = weighted_product(a, change, weights) > 0 || weighted_product(b, change, weights) < 0;
    check(VecAXPBY(a, 0.5, -0.5, b));  // (a + b)/2 of the doc comment: a's sign is changed
    const double predicted = weighted_size(a, weights);
    check(VecAXPY(a, -1, change));
    if (!(size > 1e-9 * weighted_size(U_, weights))) return {};
    if (!back && weighted_size(a, weights) <= most_departure * size) return {};
    return {t, next, size / std::max(predicted, 1e-12 * size)};
  }

  const System& system_;
  double least_;
  Vec U_, V_;
  const Jumped& jumped_;
};

}  // namespace

PetscInt follow_equilibrium(const System& system, double t, double next, double least, Vec U, Vec V,
                            const std::function<void(const BranchJump&, Vec, Vec)>& jumped) {
  return Follower(system, least, U, V, jumped).go(t, next);
}

}  // namespace floe::solve
