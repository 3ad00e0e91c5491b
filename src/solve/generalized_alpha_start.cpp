#include "generalized_alpha_data.h"

// A consistent start, at the beginning and after every restart (ts->steprestart: events, TSRestartStep):
//   A_0, lambda_0   from the start callback, or from F(t_0, U_0, V_0, A) = 0, which is linear in A
//   A'              from the same at t_0 + e and t_0 + 2e with the state moved along its Taylor series; the three-point
//                   difference is exact for the terms of order e^2, that is for stiff motions too
//   normal          the part of c A' + [v, A]/12 that the constraints see, of least norm of J; [v, A] is what
//                   rotations have (generalized_alpha_rotations.cpp)
//   A'_resolved     A' without what the step cannot resolve: (J^-1 M shift_a)^2 A', J = M shift_a + C shift_v + K, near
//                   1 for slow motions and 0 for stiff and strongly damped ones; what the constraints see of A' stays
//   A_0 at the start of the motion
//                   of stiff motions A_0 is -omega^2 times their distance from where they come to rest, as under a load
//                   that acts suddenly on a light part, and h A_0 would make omega h times the velocities that they can
//                   have (overshoot). So A_0 - (1 - R)^2 (A_0 - a) takes its place, R x = J^-1 M shift_a x: it is
//                   A_0 (1 - (omega h)^4 / ..) of motions that the step resolves. a is the acceleration that keeps
//                   forces constant to second order along the velocity, as far as the step resolves it, K a + F_qq v v
//                   = 0 (centripetal ones of elements that rotate), so that J a_1 = M shift_a A_0 - F_qq v v. A' is
//                   that of the equations along the motion with this acceleration
//   A_0 where loads jump
//                   A_0 - (1 - R)^2 (A_0 - A_before), A_before of the same state under the loads before
//   A_0 after other events
//                   A_0 - A_before is replaced by J^-1 M shift_a (A_0 - A_before) where the step does not resolve more
//                   than half of it in the norm of M: a joint was released. Also later, where a step of a constrained
//                   system is longer than the time since the event
// What the step makes of A' and normal: fresh_rates in generalized_alpha_step.cpp. A constrained system is started
// anew whenever its step size changes: the rates that suit one size would leave a transient in the multipliers, which
// grows while steps shrink. There velocities and normal part follow the constraints as far as the step resolves A - a
// (resolved_share).

namespace floe::solve {
namespace {

// A of the state (t, U, V); F is linear in A, and `inertia` is its derivative at a nearby state (exact at that one).
PetscErrorCode solve_accelerations(TS ts, Mat inertia, PetscReal t, Vec U, Vec V, Vec A) {
  GeneralizedAlpha* data = generalized_alpha_data(ts);
  KSP ksp;
  PetscReal change = PETSC_MAX_REAL, last, size;

  PetscFunctionBegin;
  PetscCall(SNESGetKSP(ts->snes, &ksp));
  PetscCall(KSPSetReusePreconditioner(ksp, PETSC_FALSE));
  PetscCall(KSPSetOperators(ksp, inertia, inertia));
  do {
    KSPConvergedReason reason;
    last = change;
    PetscCall(TSComputeI2Function(ts, t, U, V, A, data->work_F));
    PetscCall(KSPSolve(ksp, data->work_F, data->a_used));
    PetscCall(KSPGetConvergedReason(ksp, &reason));
    PetscCheck(reason >= 0, PetscObjectComm((PetscObject)ts), PETSC_ERR_NOT_CONVERGED,
               "Initial accelerations: the linear solve failed (%s); is dF/dA singular?", KSPConvergedReasons[reason]);
    PetscCall(VecAXPY(A, -1, data->a_used));
    PetscCall(VecNorm(data->a_used, NORM_2, &change));
    PetscCall(VecNorm(A, NORM_2, &size));
  } while (change > 4 * PETSC_MACHINE_EPSILON * size && change < 0.5 * last);
  PetscFunctionReturn(0);
}

// A and the multipliers in U.
PetscErrorCode accelerations(TS ts, Mat inertia, PetscReal t, Vec U, Vec V, Vec A) {
  GeneralizedAlpha* data = generalized_alpha_data(ts);

  PetscFunctionBegin;
  if (data->start)
    PetscCall((*data->start)(ts, t, U, V, A, data->start_context));
  else
    PetscCall(solve_accelerations(ts, inertia, t, U, V, A));
  PetscCall(VecPointwiseMult(A, A, data->dynamic));
  PetscFunctionReturn(0);
}

// A at t_0 + e, into work_A.
PetscErrorCode accelerations_later(TS ts, Mat inertia, PetscReal e) {
  GeneralizedAlpha* data = generalized_alpha_data(ts);

  PetscFunctionBegin;
  PetscCall(VecCopy(data->U0, data->work_U));
  PetscCall(VecAXPY(data->work_U, e, data->V0));
  PetscCall(VecAXPY(data->work_U, e * e / 2, data->A0));
  PetscCall(VecWAXPY(data->work_V, e, data->A0, data->V0));
  PetscCall(VecCopy(data->A0, data->work_A));
  PetscCall(accelerations(ts, inertia, ts->ptime + e, data->work_U, data->work_V, data->work_A));
  PetscFunctionReturn(0);
}

// A' of a motion with the acceleration A0, whose equations give `known` at its beginning.
PetscErrorCode differentiate(TS ts, Mat inertia, Vec known) {
  GeneralizedAlpha* data = generalized_alpha_data(ts);
  const PetscReal exact = (ts->ptime + 0.01 * data->h) - ts->ptime, e = exact > 0 ? exact : 0.01 * data->h;

  PetscFunctionBegin;
  PetscCall(accelerations_later(ts, inertia, e));
  PetscCall(VecCopy(data->work_A, data->jerk));
  PetscCall(accelerations_later(ts, inertia, 2 * e));
  PetscCall(VecAXPBYPCZ(data->jerk, -1.5 / e, -0.5 / e, 2 / e, known, data->work_A));
  PetscFunctionReturn(0);
}

PetscErrorCode mark_origin(TS ts) {
  GeneralizedAlpha* data = generalized_alpha_data(ts);

  PetscFunctionBegin;
  if (!data->started) {
    PetscCall(VecCopy(data->U0, data->origin));
    data->reach = data->start_reach = data->start_tried = data->start_until = 0;
    data->start_attempts = data->start_falls = 0;
  }
  PetscCall(note_rest(ts));
  PetscFunctionReturn(0);
}

// Where F's constraint rows are y (scaled), what J^-1 makes of them: the smallest motion that the constraints see so.
PetscErrorCode solve_constraint_rows(TS ts, Vec y, Vec x) {
  GeneralizedAlpha* data = generalized_alpha_data(ts);
  KSP ksp;
  KSPConvergedReason reason;

  PetscFunctionBegin;
  {
    const Entries dynamic(data->dynamic);
    Changed rows(y);
    for (PetscInt i = 0, n = local_size(y); i < n; ++i)
      if (dynamic[i] != 0) rows[i] = 0;
  }
  PetscCall(SNESGetKSP(ts->snes, &ksp));
  PetscCall(solve_scaled(ts, y, x));
  PetscCall(KSPGetConvergedReason(ksp, &reason));
  PetscCheck(reason >= 0, PetscObjectComm((PetscObject)ts), PETSC_ERR_NOT_CONVERGED,
             "Consistent start: the linear solve failed (%s); are constraints redundant?", KSPConvergedReasons[reason]);
  PetscCall(VecPointwiseMult(x, x, data->dynamic));
  PetscFunctionReturn(0);
}

// normal = the part that the constraints see of y = c A' + [v, A]/12, c as in fresh_rates: J x = (0, C_q y).
PetscErrorCode split_normal(TS ts) {
  GeneralizedAlpha* data = generalized_alpha_data(ts);
  const PetscReal c = 1. / 6 - data->beta + (data->alpha_f - data->alpha_m) / 2;

  PetscFunctionBegin;
  PetscCall(VecCopy(data->jerk, data->work_V));
  PetscCall(VecScale(data->work_V, c));
  PetscCall(add_bracket(ts, 1. / 12, data->V0, data->A0, data->work_A, data->work_V));
  PetscCall(multiply_scaled(ts, data->work_V, data->work_F));
  PetscCall(solve_constraint_rows(ts, data->work_F, data->normal));
  PetscFunctionReturn(0);
}

// F's scaled rows at (t_0 + e, q_0 + e v_0).
PetscErrorCode rows_along_velocity(TS ts, PetscReal e, Vec F) {
  GeneralizedAlpha* data = generalized_alpha_data(ts);

  PetscFunctionBegin;
  PetscCall(VecWAXPY(data->work_U, e, data->V0, data->U0));
  PetscCall(TSComputeI2Function(ts, ts->ptime + e, data->work_U, data->V0, data->A0, F));
  PetscCall(VecPointwiseMult(F, F, data->scale));
  PetscFunctionReturn(0);
}

// V0 loses a share of what violates dC/dt = 0, a central difference along the velocity (error e^2, e = h/100).
PetscErrorCode project_velocity(TS ts, PetscReal share) {
  GeneralizedAlpha* data = generalized_alpha_data(ts);
  const PetscReal e = 0.01 * data->h;

  PetscFunctionBegin;
  PetscCall(rows_along_velocity(ts, e, data->work_F));
  PetscCall(rows_along_velocity(ts, -e, data->work_A));
  PetscCall(VecAXPBY(data->work_F, -0.5 / e, 0.5 / e, data->work_A));
  PetscCall(solve_constraint_rows(ts, data->work_F, data->work_V));
  PetscCall(VecAXPY(data->V0, -share, data->work_V));
  PetscFunctionReturn(0);
}

}  // namespace

PetscErrorCode note_event(TS ts) {
  GeneralizedAlpha* data = generalized_alpha_data(ts);

  PetscFunctionBegin;
  if (!passed_since_event(ts, ts->time_step)) {
    data->forces_jump = PETSC_FALSE;  // A_before is that before another event, at which velocities may have jumped
    PetscFunctionReturn(0);
  }
  PetscCall(VecCopy(data->A0, data->A_before));
  data->t_event = ts->ptime;
  data->after_event = PETSC_TRUE;
  PetscFunctionReturn(0);
}

PetscErrorCode start_consistently(TS ts) {
  GeneralizedAlpha* data = generalized_alpha_data(ts);
  const bool begins = ts->steps == 0 && !data->after_event;
  Mat inertia = nullptr;

  PetscFunctionBegin;
  PetscCheck(data->start || !data->multipliers, PetscObjectComm((PetscObject)ts), PETSC_ERR_ARG_WRONGSTATE,
             "A constrained system needs TSGeneralizedAlphaSetStart for its initial accelerations and multipliers");
  set_step(data, ts->time_step);
  PetscCall(VecSet(data->A0, 0));
  if (data->start) PetscCall(accelerations(ts, nullptr, ts->ptime, data->U0, data->V0, data->A0));
  PetscCall(measure_scales(ts, data->start ? nullptr : &inertia));
  PetscCall(set_scales(ts));
  if (!data->start) PetscCall(accelerations(ts, inertia, ts->ptime, data->U0, data->V0, data->A0));
  PetscCall(mark_origin(ts));
  if (begins || data->forces_jump) {
    PetscCall(VecCopy(data->A0, data->normal));
    PetscCall(begins ? resolve_start(ts) : resolve_jump(ts));
    PetscCall(differentiate(ts, inertia, data->normal));
    PetscCall(jacobian_of_beginning(ts, 0, data->A0));
  } else {
    PetscCall(differentiate(ts, inertia, data->A0));
    PetscCall(take_jacobian(ts));
  }
  PetscCall(data->multipliers ? split_normal(ts) : VecSet(data->normal, 0));
  if (!data->forces_jump) PetscCall(resolve_accelerations(ts));
  data->forces_jump = PETSC_FALSE;
  PetscCall(jacobian_of_beginning(ts, data->shift_v, data->A0));
  PetscCall(resolve_jerk(ts));
  PetscCall(MatDestroy(&inertia));
  data->fresh = data->started = PETSC_TRUE;
  data->smoothed = PETSC_FALSE;
  data->h_start = data->h;
  data->equal_steps = 0;
  data->unresolved = PETSC_FALSE;
  data->rate = 1;
  PetscFunctionReturn(0);
}

PetscErrorCode smooth_rates(TS ts) {
  GeneralizedAlpha* data = generalized_alpha_data(ts);
  PetscReal share = 0;

  PetscFunctionBegin;
  PetscCall(set_scales(ts));
  PetscCall(jacobian_of_beginning(ts, data->shift_v, data->A0));
  PetscCall(resolved_share(ts, &share));
  PetscCall(project_velocity(ts, share));
  PetscCall(accelerations(ts, nullptr, ts->ptime, data->U0, data->V0, data->A0));
  PetscCall(differentiate(ts, nullptr, data->A0));
  PetscCall(split_normal(ts));
  PetscCall(VecScale(data->normal, share));
  if (!passed_since_event(ts, data->h)) {
    PetscCall(jacobian_of_beginning(ts, 0, data->A0));
    PetscCall(resolve_accelerations(ts));
    PetscCall(jacobian_of_beginning(ts, data->shift_v, data->A0));
  }
  PetscCall(resolve_jerk(ts));
  data->fresh = data->smoothed = PETSC_TRUE;
  data->h_start = data->h;
  data->equal_steps = 0;
  PetscFunctionReturn(0);
}

PetscErrorCode note_rest(TS ts) {
  GeneralizedAlpha* data = generalized_alpha_data(ts);
  PetscReal speed, acceleration;

  PetscFunctionBegin;
  data->from_rest = PETSC_FALSE;
  if (data->reach > 0) PetscFunctionReturn(0);
  PetscCall(VecNorm(data->V0, NORM_INFINITY, &speed));
  PetscCall(VecNorm(data->A0, NORM_INFINITY, &acceleration));
  if (speed == 0 && acceleration == 0) data->from_rest = PETSC_TRUE;
  PetscFunctionReturn(0);
}

}  // namespace floe::solve
