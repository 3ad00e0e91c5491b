#pragma once
#include "floe/reduction/statics.h"

namespace floe::reduction {

/// Vibration modes of a body under conditions, mass-normalised: K phi = omega^2 M phi.
struct Modes {
  std::vector<double> omega;     ///< [rad/s], ascending, by Rayleigh's quotient of the elements' strain energy
  std::vector<double> residual;  ///< |K^-1 (K phi - omega^2 M phi)|_M or a bound of it, at least the relative error of
                                 ///< omega^2
  Columns raw;                   ///< phi as the body is constrained in space
  Columns shapes;                ///< phi in the floating frame, P phi
  int left_out = 0;              ///< modes with the frequency of the last one that the count leaves out
};

/// Finds the lowest modes of the body as `holding.constrained` holds it; rigid motions that are left free are deflated,
/// not counted. More modes may be asked for later: the factorisation serves again.
///
/// EPS prefix modes_ (default: shift-invert at 0, or just below it for bodies that can still move rigidly, Cholesky by
/// MUMPS; Lanczos with blocks of eight vectors, -modes_eps_type block-lanczos, or Krylov-Schur where the body is small
/// or its factor so spoilt by round-off that solves iterate). At shift 0 under the conditions of `statics`, the solver
/// of `statics` serves with its factor and its options -derivatives_...; any option -modes_st_... gives the EPS a
/// solver of its own. The sign of each mode makes the first translation above half the maximum one positive. Where
/// frequencies repeat, all modes of one are found (lowest_pairs counts them), and combined by a rule of which neither
/// ranks nor the EPS know (the first, say, moves along y where the second stands still); then those beyond the count
/// are left out. Modes of a flat body move in its plane or out of it (fem::separate).
class ModeSolver {
 public:
  /// @param statics  a solver of the same body (also estimates the shift of a free body)
  /// All four are borrowed. No work is done yet.
  ModeSolver(const fem::Structure& structure, const fem::ReferenceFrame& frame, const fem::Holding& holding,
             const Statics& statics);
  ModeSolver(const ModeSolver&) = delete;
  ~ModeSolver();
  /// @throws InputError  more modes asked than dofs; RunError  EPS did not converge, or round-off of K leaves a
  /// frequency uncertain by 1 %. Collective. Factors at the first call.
  Modes solve(int count);
  /// How many there are.
  PetscInt available() const;

 private:
  void create(int count);
  Modes found(int count);
  const fem::Structure& structure_;
  const fem::ReferenceFrame& frame_;
  const fem::Holding& holding_;
  const Statics& statics_;
  petsc::MatHandle K_, M_, exact_;  ///< K_ only where the one of `statics` does not serve; exact_ without round-off
  petsc::EpsHandle eps_;
  double shift_ = 0;                 ///< where it looks
  mutable PetscInt available_ = -1;  ///< once it is known
};

/// The modes of a ModeSolver that is asked once. Collective.
Modes vibration_modes(const fem::Structure& structure, const fem::ReferenceFrame& frame, const fem::Holding& holding,
                      const Statics& statics, int count);

/// Flips a field's sign by the rule above. Collective.
void fix_sign(const fem::Structure& structure, Vec shape);

}  // namespace floe::reduction
