#pragma once
#include <petscts.h>

namespace floe::solve {

/// Name of the TS type: -motion_ts_type generalized-alpha.
inline constexpr const char* generalized_alpha = "generalized-alpha";

/// Registers the TS type `generalized-alpha`: Arnold and Bruels' scheme for index-3 constrained second-order systems.
///
/// F(t, U, V, A) = 0, U = (q, multipliers), by TSSetI2Function and TSSetI2Jacobian (both needed, as is TS2SetSolution).
/// Order 2 in q, v and multipliers from the first step, after restarts and through changes of the step; constraints
/// hold at the end of every step. Events, rollback, interpolation and TSADAPTBASIC work (TSSetTolerances: rtol alone
/// counts, it is relative to the maximum distance from where the run began). Newton stops at -snes_rtol (1e-10) of the
/// step's increment, whatever the units. With a fixed step the first failed solve ends the motion
/// (TS_DIVERGED_NONLINEAR_SOLVE, state kept); an adaptive one is cut up to -ts_max_reject times
/// (TS_DIVERGED_STEP_REJECTED). Defaults: direct solver (preonly, lu), full Newton steps, no adaptivity. Call once
/// after PetscInitialize. See src/dynamics/generalized_alpha.cpp for the equations. Source: Arnold, Bruels 2007,
/// Convergence of the generalized-alpha scheme for constrained mechanical systems.
void register_generalized_alpha();

/// Which unknowns are multipliers (algebraic, without rates); their rows hold C(q, t). Global indices that this rank
/// owns. `multipliers` is referenced; none set: an unconstrained system. Collective.
PetscErrorCode TSGeneralizedAlphaSetMultipliers(TS ts, IS multipliers);

/// Spectral radius at infinite frequency, 0 <= rho < 1 (option -ts_generalized_alpha_radius; default 0.8).
PetscErrorCode TSGeneralizedAlphaSetRadius(TS ts, PetscReal rho);

/// Consistent start: given t, U, V the callback fills A (initial accelerations) and the multipliers in U.
///
/// Needed with multipliers; without it an unconstrained system solves F(t, U, V, A) = 0 itself. It is called three
/// times at a start, a restart or (with multipliers) a change of the step: at the state, and at states moved along the
/// motion by some hundredths of a step (constraints then hold to that order only).
using TSGeneralizedAlphaStart = PetscErrorCode (*)(TS ts, PetscReal t, Vec U, Vec V, Vec A, void* context);
PetscErrorCode TSGeneralizedAlphaSetStart(TS ts, TSGeneralizedAlphaStart start, void* context);

/// At the next restart (TSRestartStep) forces jump and velocities do not. What the step does not resolve of the jump of
/// A is left out of it, each motion for itself, as at the start of a motion.
PetscErrorCode TSGeneralizedAlphaSetForcesJump(TS ts);

/// Forces depend on the state and may begin and end within a step: an adaptive step is refused where they do so unseen
/// at its ends.
PetscErrorCode TSGeneralizedAlphaSetStateLoads(TS ts);

/// Rotations among the unknowns, A = base exp(x), whose rates are angular velocities in rotated axes (not dx/dt).
/// Source: Bruels, Cardona, Arnold 2012, Lie group generalized-alpha time integration of constrained flexible multibody
/// systems.
///
/// `rebase` takes the rotations of U over into their bases and zeroes them. It is called with the solution at the
/// beginning of every step, before anything is computed, and not when a step is tried again: until the next beginning
/// the solution (at the step's end, after a rollback, interpolated) is relative to that base. `bracket` fills W with
/// a x b in the rows of rotations and zero in all others: what such rates differ by from derivatives. Both or none.
///
/// `rotate`, if given, is for a Jacobian that is kept while bodies rotate: it rotates a vector y of rows or of unknowns
/// as they rotated from where TSI2Jacobian was called last to U (or back), so that J(U) is about rotate J rotate_back.
/// Newton's updates are made with that.
struct TSGeneralizedAlphaRotations {
  PetscErrorCode (*rebase)(TS ts, Vec U, void* context) = nullptr;
  PetscErrorCode (*bracket)(TS ts, Vec a, Vec b, Vec W, void* context) = nullptr;
  void* context = nullptr;
  PetscErrorCode (*rotate)(TS ts, Vec U, PetscBool back, Vec y, void* context) = nullptr;
  IS angles = nullptr;  ///< rotations in the plane [rad], global indices that this rank owns; referenced
};
PetscErrorCode TSGeneralizedAlphaSetRotations(TS ts, const TSGeneralizedAlphaRotations* rotations);

/// The accelerations that belong to the current solution (borrowed, until the next step). NULL before the first step
/// and for other types.
PetscErrorCode TSGeneralizedAlphaGetAcceleration(TS ts, Vec* A);

/// Of the first step after a restart (TSRestartStep), and of later ones that are longer than the time since: the
/// estimated local error over the step's path |q_1 - q_0|, both in the norm sqrt(sum M_ii q_i^2). The path counts at
/// least as 1e-4 of the distance from where the run began. It is about the relative error that velocities keep from
/// then on. 0 for other steps, with adaptive steps and for other types.
PetscErrorCode TSGeneralizedAlphaGetEventError(TS ts, PetscReal* error);

/// U and its rates V within the last step, a cubic and a quadratic polynomial between its ends (errors of fourth and
/// third order in the step); multipliers in U are linear, and zero in V. A is linear. Rotations are relative to the
/// base that the step's end has.
PetscErrorCode TSGeneralizedAlphaInterpolate(TS ts, PetscReal t, Vec U, Vec V, Vec A);

}  // namespace floe::solve
