#pragma once
#include <vector>

#include "floe/fem/reference_frame.h"

namespace floe::reduction {

using Columns = std::vector<petsc::VecHandle>;

/// Solves K u = P' f for many loads with one factorisation, and hands u back in the floating frame (P u).
///
/// K stands under Holding::statics: where joints hold the body they restrict u (an axially immovable end stays put),
/// where they leave it free any supplement gives the same answer, because P' f is self-equilibrated. KSP prefix
/// derivatives_ (default: Cholesky by MUMPS, blocks of right-hand sides).
class Statics {
 public:
  /// Factors K at the first solve. Collective.
  Statics(const fem::Structure& structure, const fem::ReferenceFrame& frame, const fem::Holding& holding);
  /// @throws RunError  not converged. Collective. One block solve.
  Columns solve(const Columns& loads) const;

  /// For those who need K under the same conditions: the matrix, its conditions, and the solver with its factor.
  Mat stiffness() const { return K_; }
  const fem::Conditions& conditions() const { return conditions_; }
  KSP solver() const { return ksp_; }

 private:
  const fem::ReferenceFrame& frame_;
  fem::Conditions conditions_;
  petsc::MatHandle K_;
  petsc::KspHandle ksp_;
};

/// A direct solver for A (MATSBAIJ) by MUMPS' Cholesky / LDL', with `prefix` for the user's options. Collective.
petsc::KspHandle direct_solver(Mat A, const char* prefix);

/// X with A X = B for all columns at once. @throws RunError with prefix, reason and residual. Collective.
Columns block_solve(KSP ksp, const Columns& B);

/// Deep copies. Collective.
petsc::VecHandle copy(Vec vector);

}  // namespace floe::reduction
