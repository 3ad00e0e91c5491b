#pragma once
#include <string>
#include <vector>

#include "floe/fem/element_stiffness.h"
#include "floe/fem/reference_frame.h"

namespace floe::reduction {

using Columns = std::vector<petsc::VecHandle>;

/// Solves K u = P' f for many loads with one factorisation, and hands u back in the floating frame (P u).
///
/// K stands under Holding::statics: where joints hold the body they restrict u (an axially immovable end stays put),
/// where they leave it free any supplement gives the same answer, because P' f is self-equilibrated. KSP prefix
/// derivatives_ (default: Cholesky by MUMPS, blocks of right-hand sides; where round-off touches the factor, corrected
/// with the exact operator; where it spoils it, GMRES on that operator, preconditioned by the factor).
class Statics {
 public:
  /// Factors K at the first solve. Collective.
  Statics(const fem::Structure& structure, const fem::ReferenceFrame& frame, const fem::Holding& holding);
  /// Factors K unless that is done; who solves with K does it anyway. Collective.
  void factor() const;
  /// @throws RunError  not converged. Collective. One block solve.
  Columns solve(const Columns& loads) const;
  /// The same for the columns of a dense matrix, which is used up.
  Columns solve(petsc::MatHandle loads) const;
  /// Responses about a deformation q that the frame measures: x = P w with
  ///
  ///   P' K_T P w = P' f,   K_T = d2U/dq2 at q,   w = 0 where joints hold it
  ///
  /// A rigid motion of w costs nothing, though K_T knows of it, for von Karman's strains do: any supplement of the
  /// conditions gives the same. Solved with a factor of K_T under conditions(), which P changes by a matrix of twice as
  /// low a rank as there are rigid motions (Sherman, Morrison and Woodbury). Empty where K_T has no factor, and where
  /// nothing factors K or round-off spoils its factor. One factorisation for all loads, KSP prefix derivatives_.
  /// Collective.
  Columns solve_bent(Vec q, const Columns& loads) const;
  /// Static constraint modes, in the floating frame: conditions() displaced as `moved` says (zero at all other dofs)
  /// and the others constrained to zero, u = e + v, K v = -K e. One that is a rigid motion is zero. Source: Craig and
  /// Bampton 1968. Collective. One block solve, the same factor.
  Columns constraint_modes(const Columns& moved) const;
  /// The same as they are, not in the frame: together they may be a rigid motion.
  Columns displaced(const Columns& moved) const;

  /// For those who need K under the same conditions: the matrix, its conditions, and the solver with its factor.
  Mat stiffness() const { return K_; }
  const fem::Conditions& conditions() const { return conditions_; }
  KSP solver() const;
  /// Whether this is the solver; unlike solver(), measures nothing.
  bool owns(KSP ksp) const { return ksp == ksp_; }

  /// K without its round-off: by elements, and as an operator under the conditions.
  const std::shared_ptr<const fem::ElementStiffness>& elements() const { return elements_; }
  Mat exact_stiffness() const { return exact_; }
  /// Whether the factor misses too much to be a solver by itself: for one smooth load f and u = K^-1 f,
  /// |K^-1 (f - K_exact u)| > 1e-8 |u|. It grows as eps (L/h)^4. Collective; factors, and solves twice, at first.
  bool refines() const { return factor_error() > 1e-8; }
  /// Whether it misses so much that solver() is an iteration: more than 1e-3.
  bool iterates() const { return factor_error() > 1e-3; }
  /// That number. Collective, as refines().
  double factor_error() const;

 private:
  double measured_error() const;
  double missing(Mat loads, Mat u) const;
  void correct(Mat loads, Mat u) const;
  Columns corrected(petsc::MatHandle loads) const;
  void prepare(Mat loads) const;
  void finish(const Columns& u) const;
  const fem::ReferenceFrame& frame_;
  fem::Conditions conditions_;
  petsc::MatHandle K_;
  std::shared_ptr<const fem::ElementStiffness> elements_;
  petsc::MatHandle exact_;
  petsc::KspHandle ksp_;
  mutable double factor_error_ = -1;  ///< not measured yet
};

/// A direct solver for A (MATSBAIJ) by MUMPS' Cholesky / LDL', with `prefix` for the user's options. Right-hand sides
/// go through it 64 at a time (MUMPS' ICNTL(27)), unless the options say otherwise. Collective.
petsc::KspHandle direct_solver(Mat A, const char* prefix);

/// Turns a direct solver into an iteration that its factor preconditions: a few steps, to 1e-12 of the preconditioned
/// residual (the other norm is all round-off of u, multiplied by EI/h^3). The operator is set by the caller.
void iterate(KSP ksp, KSPType type);

/// `the mesh of N elements is finer than double precision resolves: WHAT; ...`; thinner, of thin folds; of
/// quadrilaterals of second order that stand alone, which of their motions cost no energy. Collective.
RunError too_fine(const fem::Structure& structure, const std::string& what);

/// X with A X = B for all columns at once. @throws RunError with prefix, reason and residual. Collective.
Columns block_solve(KSP ksp, const Columns& B);
/// The same for dense matrices, of one layout.
void block_solve(KSP ksp, Mat B, Mat X);

/// A dense matrix of `count` columns like one, assembled, zero; and one with the given columns. Collective.
petsc::MatHandle dense_like(Vec column, std::size_t count);
petsc::MatHandle dense_of(const Columns& columns);
Columns columns_of(Mat dense);

/// Whether dofs constrained to zero include all conditions of the frame: displacements are then in the frame as they
/// are, and what P' changes in a load is borne by constrained dofs.
bool holds_frame(const fem::ReferenceFrame& frame, const fem::Conditions& constrained);

/// Deep copies. Collective.
petsc::VecHandle copy(Vec vector);

}  // namespace floe::reduction
