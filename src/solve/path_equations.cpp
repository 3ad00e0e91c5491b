#include "path_equations.h"

#include <algorithm>
#include <cmath>

#include "floe/petsc/factorisation.h"
#include "floe/solve/start.h"

namespace floe::solve {

using petsc::check;

PathEquations::PathEquations(const System& system, double interval, Vec V, Vec weights)
    : system_(system),
      interval_(interval),
      V_(V),
      weights_(weights),
      A_(system.create_vector()),
      F_(system.create_vector()),
      rate_(system.create_vector()),
      J_(system.create_tangent()),
      ksp_(tangent_solver(J_, "static_")) {}

bool PathEquations::solve(const PathVector& x, const PathSolutions& s) {
  const double below = residual_below(x);
  check(VecCopy(F_, rate_));
  system_.residual(x.t + interval_, x.U, V_, A_, ConstraintLevel::position, F_);
  check(VecAXPY(rate_, -1, F_));
  check(VecScale(rate_, 1 / (interval_ + below)));
  system_.residual(x.t, x.U, V_, A_, ConstraintLevel::position, F_);
  check(VecScale(F_, -1));
  system_.tangent(x.t, x.U, V_, A_, {1, 0, 0}, J_);
  check(KSPSetOperators(ksp_, J_, J_));
  return solve_one(rate_, s.a) && solve_one(F_, s.b);
}

double PathEquations::max_chord(const PathVector& x, double first, double end) {
  constexpr int samples = 10;
  const petsc::VecHandle chord = system_.create_vector();
  double most = 0;
  for (int k = 0; k <= samples; ++k) {
    const double d = k == 0 ? std::copysign(first, end - x.t) : (end - x.t) * k / samples;
    double size = 0;
    if (!residual_at(x.t + d, x.U, rate_)) continue;
    check(VecAXPY(rate_, 1, F_));  // F_ is -F(t)
    check(VecScale(rate_, 1 / d));
    check(VecNorm(rate_, NORM_INFINITY, &size));
    if (std::isfinite(size) && solve_one(rate_, chord)) most = std::max(most, weighted_size(chord, weights_));
  }
  return most;
}

bool PathEquations::residual_at(double t, Vec U, Vec F) {
  try {
    system_.residual(t, U, V_, A_, ConstraintLevel::position, F);
    return true;
  } catch (const petsc::Error&) {
    throw;
  } catch (const std::runtime_error&) {
    return false;
  }
}

double PathEquations::residual_below(const PathVector& x) {
  if (residual_at(x.t - interval_, x.U, F_)) return interval_;
  system_.residual(x.t, x.U, V_, A_, ConstraintLevel::position, F_);
  return 0;
}

bool PathEquations::solve_one(Vec right, Vec x) {
  double size = 0;
  try {
    check(KSPSolve(ksp_, right, x));
  } catch (const petsc::Error& error) {
    if (!is_singular(error.code())) throw;
    if (const petsc::FactorFault fault = petsc::factor_fault(ksp_); !fault.text.empty() && !fault.singular)
      throw RunError(fault.text);
    return false;
  }
  KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
  check(KSPGetConvergedReason(ksp_, &reason));
  check(VecNorm(x, NORM_INFINITY, &size));
  return reason >= 0 && std::isfinite(size);
}

void add_to(PathVector& x, double factor, const PathVector& d) {
  check(VecAXPY(x.U, factor, d.U));
  x.t += factor * d.t;
}

void set_to(PathVector& x, const PathVector& from) {
  check(VecCopy(from.U, x.U));
  x.t = from.t;
}

}  // namespace floe::solve
