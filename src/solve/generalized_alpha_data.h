#pragma once
#include <petsc/private/tsimpl.h>

#include "floe/solve/generalized_alpha.h"

namespace floe::solve {

/// What a TS of type generalized-alpha holds. Equations and symbols: generalized_alpha.cpp.
struct GeneralizedAlpha {
  PetscReal rho = 0, alpha_m = 0, alpha_f = 0, gamma = 0, beta = 0;
  IS multipliers = nullptr;
  TSGeneralizedAlphaStart start = nullptr;
  void* start_context = nullptr;
  TSGeneralizedAlphaRotations rotations;

  // The step's beginning (0) and end (1): A is the acceleration, a the auxiliary one; multipliers have V = A = a = 0.
  Vec U0 = nullptr, V0 = nullptr, A0 = nullptr, a0 = nullptr;
  Vec U1 = nullptr, V1 = nullptr, A1 = nullptr, a1 = nullptr;
  PetscReal h = 0;     // of the step under way, or of the last one
  PetscReal h_a0 = 0;  // of the step that a0 was made for
  // Steps of the size h before the one under way whose a is known: a0 of the first, a1 (until this step ends) of the
  // second.
  PetscInt equal_steps = 0;
  PetscBool started = PETSC_FALSE;

  // A step needed a start of Newton's method without motions that it does not resolve; so do those that follow, as long
  // as there are any.
  PetscBool unresolved = PETSC_FALSE;

  // After a start (and for constrained systems after a change of h): rate of A that it resolves; h^2 normal is what v_n
  // is away from v(t_n) normal to the constraints.
  PetscBool fresh = PETSC_FALSE, from_rest = PETSC_FALSE, smoothed = PETSC_FALSE;  // smoothed: after a change of h
  PetscReal h_start = 0;                                                           // the step that they were made for
  Vec jerk = nullptr, normal = nullptr;

  // A before the last event, and its time; of events that follow each other within the coming step, the first. Of a
  // step that is longer than the time since then (passed_since_event), what it does not resolve of A - A_before is left
  // out.
  PetscBool after_event = PETSC_FALSE;
  Vec A_before = nullptr;
  PetscReal t_event = 0;
  PetscBool forces_jump = PETSC_FALSE;  // at the event that follows, and velocities do not
  PetscBool state_loads = PETSC_FALSE;  // TSGeneralizedAlphaSetStateLoads
  PetscReal event_error = 0;            // TSGeneralizedAlphaGetEventError

  // Constants of the step under way: a_n as used, and what the rates are affine in.
  Vec a_used = nullptr, base_q = nullptr, base_v = nullptr, base_A = nullptr;
  PetscReal shift_v = 0, shift_a = 0;

  // Of each row: 1 for dynamic and 0 for constraint; |dF/dU|_ii, |dF/dA|_ii; 1 / norm of a constraint row.
  Vec dynamic = nullptr, stiffness = nullptr, mass = nullptr, row = nullptr;
  Vec attitude_rows = nullptr, rotation_rows = nullptr;  // of each row: 1 for an attitude, for that or an angle; else 0
  Vec scale = nullptr, weight = nullptr;  // row scaling and |J_ii| (0 for multipliers), for the step size h_scale
  PetscReal h_scale = 0;
  Vec column = nullptr;  // column scaling of the Jacobian that was formed last: 1 where `two_sided` is not set
  PetscBool two_sided = PETSC_FALSE;

  // Newton's updates in the step under way, and what earlier steps taught about their rate.
  PetscReal update = 0, best = 0, first_update = 0, first_residual = 0;
  PetscReal whole_update = 0;  // multipliers included
  PetscInt idle = 0, growing = 0;
  PetscReal rate = 1, rate_update = 0;  // the rate seen last, and the first update of that solve
  PetscBool rate_of_old_jacobian = PETSC_FALSE;
  PetscBool new_jacobian = PETSC_FALSE, formed = PETSC_FALSE;  // since the last update; in this solve

  // How far q has been from where the run began, mass norm: what a local error is compared with.
  Vec origin = nullptr;
  PetscReal reach = 0, reach_tried = 0;
  PetscReal start_reach = 0, start_tried = 0, start_h = 0;  // of attempts at a first step from rest
  PetscReal start_until = 0;                                // the end of the attempt that start_reach is of
  PetscInt start_attempts = 0, start_falls = 0;

  // Where the Jacobian that SNES has was formed: a motion that is taken up again forms it once more.
  Vec tangent_U = nullptr, tangent_V = nullptr, tangent_A = nullptr;
  PetscReal tangent_t = 0, tangent_shift_v = 0, tangent_shift_a = 0;

  Vec middle_U = nullptr, middle_V = nullptr, middle_A = nullptr;  // of the step: local_error
  Vec work_U = nullptr, work_V = nullptr, work_A = nullptr, work_F = nullptr;
};

inline GeneralizedAlpha* generalized_alpha_data(TS ts) { return static_cast<GeneralizedAlpha*>(ts->data); }

/// Whether a step of size h from now on is no longer than the time since the last event.
inline bool passed_since_event(TS ts, PetscReal h) {
  const GeneralizedAlpha* data = generalized_alpha_data(ts);
  return !data->after_event || h <= (1 + 1e-9) * (ts->ptime - data->t_event);
}

/// The step under way gets the size h.
inline void set_step(GeneralizedAlpha* data, PetscReal h) {
  data->h = h;
  data->shift_v = data->gamma / (data->beta * h);
  data->shift_a = (1 - data->alpha_m) / ((1 - data->alpha_f) * data->beta * h * h);
}

/// The local entries of a vector, for plain loops: Entries x(vec); x[i]. Changed needs write access, Entries does not.
class Entries {
 public:
  explicit Entries(Vec vec) : vec_(vec) { VecGetArrayRead(vec_, &array_); }
  ~Entries() { VecRestoreArrayRead(vec_, &array_); }
  Entries(const Entries&) = delete;
  Entries& operator=(const Entries&) = delete;
  PetscScalar operator[](PetscInt i) const { return array_[i]; }

 private:
  Vec vec_;
  const PetscScalar* array_ = nullptr;
};

class Changed {
 public:
  explicit Changed(Vec vec) : vec_(vec) { VecGetArray(vec_, &array_); }
  ~Changed() { VecRestoreArray(vec_, &array_); }
  Changed(const Changed&) = delete;
  Changed& operator=(const Changed&) = delete;
  PetscScalar& operator[](PetscInt i) const { return array_[i]; }

 private:
  Vec vec_;
  PetscScalar* array_ = nullptr;
};

inline PetscInt local_size(Vec vec) {
  PetscInt n = 0;
  VecGetLocalSize(vec, &n);
  return n;
}

// generalized_alpha_start.cpp
/// Fills U0 (multipliers), A0, jerk, normal and the constants of scaling from (ts->ptime, U0, V0). Collective.
PetscErrorCode start_consistently(TS ts);

/// A0 is that before an event; start_consistently follows. Collective.
PetscErrorCode note_event(TS ts);

/// The same for a constrained system whose step size changes; V0 also loses what violates dC/dt = 0, as far as the step
/// resolves A - a. Collective.
PetscErrorCode smooth_rates(TS ts);

// generalized_alpha_resolution.cpp
/// The Jacobian that was just formed, scaled and made the solver's.
PetscErrorCode take_jacobian(TS ts);
/// J(shift_v, shift_a) of the state that the step begins with, made the solver's; A: null for zero accelerations.
PetscErrorCode jacobian_of_beginning(TS ts, PetscReal shift_v, Vec A);
/// A_0 without what a step that is longer than the time since an event does not resolve; J of A_0 is in the solver.
/// What is removed must not change momentum; the derivative of M A_0 with respect to q would, and is as large as A_0.
PetscErrorCode resolve_accelerations(TS ts);
/// A_0 of the start of the motion without what the step does not resolve, each motion for itself; a load that balances
/// another force has no part in A_0. A_0 stays where the forces have no curvature along the velocity (a stop within a
/// tenth of the step) or J is nearly singular. J of zero rates is in the solver. Collective.
PetscErrorCode resolve_start(TS ts);
/// A_0 after a jump of loads, which is A_before before it, without what the step does not resolve of the jump, each
/// motion for itself. J of zero rates is in the solver. Collective.
PetscErrorCode resolve_jump(TS ts);
/// A' of a start without what the step does not resolve; J is in the solver.
PetscErrorCode resolve_jerk(TS ts);
/// How much of A - a, which is h shift A' of smooth motions, the step resolves, in the norm of M: 1 where it is all, 0
/// where a fifth is lost. Where stiff or strongly damped motions are in it, A' is theirs, and what the constraints see
/// of that is noise.
PetscErrorCode resolved_share(TS ts, PetscReal* share);
/// Removes from U - U0, an estimate of the step's end, what the step does not resolve: of stiff motions h^2 a_0 / 2 is
/// (omega h)^2 / 2 times their amplitude. Multipliers become those of U0. Leaves J of the step's beginning in the
/// solver. Collective.
///
/// @param reach  how far the step's end can be: twice the distance of what is kept, and h |V0|; 0: U stays, because J
///               cannot be solved or because U has none of them
PetscErrorCode keep_resolved(TS ts, Vec U, PetscReal* reach);
/// sqrt((U - U0)' M (U - U0)). Collective.
PetscErrorCode distance(TS ts, Vec U, PetscReal* far);

// generalized_alpha_rotations.cpp
/// Fills `attitude_rows`. Collective.
PetscErrorCode mark_attitudes(TS ts);
/// ts->vec_sol takes its own rotations for bases; `origin` moves with it. Collective.
PetscErrorCode rebase(TS ts);

/// Sets from_rest: nothing has moved since the run began, nor does it at the beginning of the step. Collective.
PetscErrorCode note_rest(TS ts);
/// y += factor [a, b]; W is overwritten.
PetscErrorCode add_bracket(TS ts, PetscReal factor, Vec a, Vec b, Vec W, Vec y);

/// A Rotate (simplified_newton.h) in scaled rows; context: the TS.
PetscErrorCode rotation_kept(SNES snes, Vec U, PetscBool back, Vec y, void* context);

// generalized_alpha_scaling.cpp
/// Constants of scaling: Jacobians at the state (U0, V0, A0) with shift_a; leaves J(shift_v = 0, shift_a), unscaled.
///
/// @param inertia  if not NULL receives a new matrix dF/dA
PetscErrorCode measure_scales(TS ts, Mat* inertia);
/// Sets scale and weight for the shifts under way, and lets SNES form a new Jacobian.
PetscErrorCode set_scales(TS ts);
/// Scales a Jacobian that was just formed. What is solved with it, and multiplied with it, goes through the two below.
PetscErrorCode scale_jacobian(TS ts, Mat P);
/// x = J^-1 b and y = J x, rows scaled. The KSP says how the first went.
PetscErrorCode solve_scaled(TS ts, Vec b, Vec x);
PetscErrorCode multiply_scaled(TS ts, Vec x, Vec y);
/// Lets SNES form a new Jacobian and a new factorisation at the given iteration, whatever the lags.
void renew_jacobian(SNES snes, PetscInt iteration);

// generalized_alpha_predict.cpp
enum class Guess { extrapolated, plain };
/// Where Newton's method starts, into U1. Collective.
PetscErrorCode predict(TS ts, Guess guess);

// generalized_alpha_step.cpp
PetscErrorCode step(TS ts);
PetscErrorCode roll_back(TS ts);
/// Of the step from U0 to U1, which is h long, at x h, 0 <= x <= 1; uses work_U and work_V.
PetscErrorCode state_within(TS ts, PetscReal h, PetscReal x, Vec U, Vec V, Vec A);
PetscErrorCode interpolate(TS ts, PetscReal t, Vec U);
PetscErrorCode interpolate_all(TS ts, PetscReal t, Vec U, Vec V, Vec A);
PetscErrorCode form_function(SNES snes, Vec U, Vec F, TS ts);
PetscErrorCode form_jacobian(SNES snes, Vec U, Mat J, Mat P, TS ts);

// generalized_alpha_control.cpp
/// Newton's convergence test (SNESSetConvergenceTest), context: the TS.
PetscErrorCode newton_converged(SNES snes, PetscInt iteration, PetscReal, PetscReal, PetscReal residual,
                                SNESConvergedReason* reason, void* context);
PetscErrorCode local_error(TS ts, NormType, PetscInt* order, PetscReal* error);
/// Sets event_error for the step that was accepted. Collective.
PetscErrorCode measure_event_error(TS ts);

}  // namespace floe::solve
