#include "generalized_alpha_data.h"

// What a step can resolve: J^-1 (M shift_a x), J = M shift_a + C shift_v + K, is near x for slow motions and near 0 for
// stiff and strongly damped ones. Applied to accelerations at the start and after events, to A' of a start, to A - a
// where the step changes, and to estimates of a step's end.

namespace floe::solve {
namespace {

// y = M x at the step's beginning: M e x is F(.., A + e x) - F(.., A), for F is linear in A; e makes an acceleration of
// x.
PetscErrorCode multiply_inertia(TS ts, PetscReal e, Vec x, Vec y) {
  GeneralizedAlpha* data = generalized_alpha_data(ts);

  PetscFunctionBegin;
  PetscCall(VecWAXPY(data->work_A, e, x, data->A0));
  PetscCall(TSComputeI2Function(ts, ts->ptime, data->U0, data->V0, data->work_A, y));
  PetscCall(TSComputeI2Function(ts, ts->ptime, data->U0, data->V0, data->A0, data->work_A));
  PetscCall(VecAXPY(y, -1, data->work_A));
  PetscCall(VecScale(y, 1 / e));
  PetscFunctionReturn(0);
}

// x <- J^-1 rows, scaled rows, of the dynamic unknowns.
PetscErrorCode solve_rows(TS ts, Vec rows, Vec x, KSPConvergedReason* reason) {
  KSP ksp;

  PetscFunctionBegin;
  PetscCall(SNESGetKSP(ts->snes, &ksp));
  PetscCall(solve_scaled(ts, rows, x));
  PetscCall(KSPGetConvergedReason(ksp, reason));
  PetscCall(VecPointwiseMult(x, x, generalized_alpha_data(ts)->dynamic));
  PetscFunctionReturn(0);
}

// x <- J^-1 (M shift_a x), with the constraint rows C_q x. The operator acts on motions, not on coordinates: a frame
// that rotates and elastic coordinates that rotate it back are one motion, whatever the stiffness of either coordinate
// by itself.
PetscErrorCode leave_out_stiff(TS ts, PetscReal e, Vec x, KSPConvergedReason* reason) {
  GeneralizedAlpha* data = generalized_alpha_data(ts);

  PetscFunctionBegin;
  PetscCall(multiply_inertia(ts, e, x, data->work_F));
  PetscCall(multiply_scaled(ts, x, data->work_V));
  {
    const Entries dynamic(data->dynamic), scale(data->scale), seen(data->work_V);
    Changed rows(data->work_F);
    for (PetscInt i = 0, n = local_size(data->work_F); i < n; ++i)
      rows[i] = dynamic[i] != 0 ? scale[i] * data->shift_a * rows[i] : seen[i];
  }
  PetscCall(solve_rows(ts, data->work_F, x, reason));
  PetscFunctionReturn(0);
}

// The Jacobian of the state that the step begins with, without its rates, made the solver's.
PetscErrorCode jacobian_at_rest(TS ts) {
  GeneralizedAlpha* data = generalized_alpha_data(ts);
  Mat J, P;

  PetscFunctionBegin;
  PetscCall(VecSet(data->work_V, 0));
  PetscCall(SNESGetJacobian(ts->snes, &J, &P, nullptr, nullptr));
  PetscCall(TSComputeI2Jacobian(ts, ts->ptime, data->U0, data->work_V, data->work_V, 0, data->shift_a, J, P));
  PetscCall(take_jacobian(ts));
  PetscFunctionReturn(0);
}

// sqrt(x' M x) at the state that the step begins with; e as in multiply_inertia.
PetscErrorCode inertia_norm(TS ts, PetscReal e, Vec x, PetscReal* norm) {
  GeneralizedAlpha* data = generalized_alpha_data(ts);

  PetscFunctionBegin;
  PetscCall(multiply_inertia(ts, e, x, data->work_F));
  PetscCall(VecDot(x, data->work_F, norm));
  *norm = PetscSqrtReal(PetscMax(*norm, 0));
  PetscFunctionReturn(0);
}

// x <- A_0 - A_before.
PetscErrorCode jump_of_accelerations(GeneralizedAlpha* data, Vec x) {
  PetscFunctionBegin;
  PetscCall(VecWAXPY(x, -1, data->A_before, data->A0));
  PetscFunctionReturn(0);
}

// x <- R x, R x = J^-1 (M shift_a x). Where this increases the norm, by more than round-off of *whole, J is nearly
// singular, and *good is PETSC_FALSE. *whole becomes the norm that x had, if that is more.
PetscErrorCode resolve_once(TS ts, PetscReal e, Vec x, PetscReal* whole, PetscBool* good) {
  KSPConvergedReason reason;
  PetscReal before, after;

  PetscFunctionBegin;
  PetscCall(inertia_norm(ts, e, x, &before));
  PetscCall(leave_out_stiff(ts, e, x, &reason));
  PetscCall(inertia_norm(ts, e, x, &after));
  PetscCall(PetscInfo(ts, "Start: norm %g, of what the step resolves %g\n", (double)before, (double)after));
  *good = reason >= 0 && after <= 1.5 * before + 1e-6 * *whole ? PETSC_TRUE : PETSC_FALSE;
  *whole = PetscMax(*whole, before);
  PetscFunctionReturn(0);
}

// x <- a + (1 - (1 - R)^2) (x - a), with (1 - R) a given: what of x the step resolves, to the fourth power of omega h.
// Overwrites U1.
PetscErrorCode keep_resolved_part(TS ts, PetscReal e, Vec x, Vec stays, PetscBool* good) {
  GeneralizedAlpha* data = generalized_alpha_data(ts);
  PetscReal whole = 0;

  PetscFunctionBegin;
  PetscCall(VecCopy(x, data->U1));
  PetscCall(resolve_once(ts, e, x, &whole, good));
  if (!*good) PetscFunctionReturn(0);
  if (stays) PetscCall(VecAXPY(x, 1, stays));
  PetscCall(VecAXPY(data->U1, -1, x));
  PetscCall(resolve_once(ts, e, data->U1, &whole, good));
  PetscCall(VecAXPY(x, 1, data->U1));
  PetscFunctionReturn(0);
}

// y <- F at (t_0, q_0 + e v) without rates.
PetscErrorCode forces_along(TS ts, PetscReal e, Vec v, Vec y) {
  GeneralizedAlpha* data = generalized_alpha_data(ts);

  PetscFunctionBegin;
  PetscCall(VecWAXPY(data->work_U, e, v, data->U0));
  PetscCall(VecSet(data->work_V, 0));
  PetscCall(TSComputeI2Function(ts, ts->ptime, data->work_U, data->work_V, data->work_V, y));
  PetscFunctionReturn(0);
}

// x <- -J^-1 F_qq v v of the forces, a central difference over e: (1 - R) a, where K a + F_qq v v = 0.
PetscErrorCode curved(TS ts, PetscReal e, Vec v, Vec x, KSPConvergedReason* reason) {
  GeneralizedAlpha* data = generalized_alpha_data(ts);

  PetscFunctionBegin;
  PetscCall(forces_along(ts, 0, v, x));
  PetscCall(VecScale(x, 2));
  for (const PetscReal to : {e, -e}) {
    PetscCall(forces_along(ts, to, v, data->work_A));
    PetscCall(VecAXPY(x, -1, data->work_A));
  }
  PetscCall(VecScale(x, 1 / (e * e)));
  PetscCall(VecPointwiseMult(x, x, data->dynamic));
  PetscCall(VecPointwiseMult(data->work_F, x, data->scale));
  PetscCall(solve_rows(ts, data->work_F, x, reason));
  PetscFunctionReturn(0);
}

// The same over h/10, into x; overwrites U1. *good is PETSC_FALSE where the forces are not smooth along v: where a stop
// or a gap lies within that distance, the difference over a quarter of it is another one. Centripetal accelerations
// change v by less than v in a step.
PetscErrorCode acceleration_of_curvature(TS ts, Vec v, Vec x, PetscBool* good) {
  GeneralizedAlpha* data = generalized_alpha_data(ts);
  KSPConvergedReason first, second;
  PetscReal speed, size, difference;

  PetscFunctionBegin;
  PetscCall(curved(ts, 0.1 * data->h, v, x, &first));
  PetscCall(curved(ts, 0.025 * data->h, v, data->U1, &second));
  PetscCall(VecAXPY(data->U1, -1, x));
  PetscCall(inertia_norm(ts, 1 / data->h, v, &speed));
  PetscCall(inertia_norm(ts, 1, x, &size));
  PetscCall(inertia_norm(ts, 1, data->U1, &difference));
  PetscCall(PetscInfo(ts, "Start: norm of the velocity %g, its change by curvature %g, uncertain by %g\n",
                      (double)speed, (double)(data->h * size), (double)(data->h * difference)));
  const bool bounded = data->h * size <= speed && data->h * difference <= 0.05 * speed;
  *good = first >= 0 && second >= 0 && bounded ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}

}  // namespace

PetscErrorCode take_jacobian(TS ts) {
  Mat P;
  KSP ksp;

  PetscFunctionBegin;
  PetscCall(SNESGetJacobian(ts->snes, nullptr, &P, nullptr, nullptr));
  PetscCall(scale_jacobian(ts, P));
  PetscCall(SNESGetKSP(ts->snes, &ksp));
  PetscCall(KSPSetReusePreconditioner(ksp, PETSC_FALSE));
  PetscCall(KSPSetOperators(ksp, P, P));
  PetscFunctionReturn(0);
}

PetscErrorCode jacobian_of_beginning(TS ts, PetscReal shift_v, Vec A) {
  GeneralizedAlpha* data = generalized_alpha_data(ts);
  Mat J, P;

  PetscFunctionBegin;
  if (!A) PetscCall(VecSet(data->work_A, 0));
  PetscCall(SNESGetJacobian(ts->snes, &J, &P, nullptr, nullptr));
  PetscCall(TSComputeI2Jacobian(ts, ts->ptime, data->U0, data->V0, A ? A : data->work_A, shift_v, data->shift_a, J, P));
  PetscCall(take_jacobian(ts));
  PetscFunctionReturn(0);
}

PetscErrorCode resolve_accelerations(TS ts) {
  GeneralizedAlpha* data = generalized_alpha_data(ts);
  KSPConvergedReason reason;
  PetscReal whole, lost;

  PetscFunctionBegin;
  if (passed_since_event(ts, data->h)) PetscFunctionReturn(0);
  PetscCall(jump_of_accelerations(data, data->V1));
  PetscCall(VecCopy(data->V1, data->work_U));
  PetscCall(inertia_norm(ts, 1, data->V1, &whole));
  PetscCall(leave_out_stiff(ts, 1, data->work_U, &reason));
  if (reason < 0) PetscFunctionReturn(0);
  PetscCall(VecAXPY(data->V1, -1, data->work_U));
  PetscCall(inertia_norm(ts, 1, data->V1, &lost));
  if (!(lost > 0.5 * whole)) PetscFunctionReturn(0);
  PetscCall(jacobian_of_beginning(ts, 0, nullptr));
  PetscCall(jump_of_accelerations(data, data->work_U));
  PetscCall(leave_out_stiff(ts, 1, data->work_U, &reason));
  PetscCheck(reason >= 0, PetscObjectComm((PetscObject)ts), PETSC_ERR_NOT_CONVERGED,
             "Consistent start: the linear solve failed (%s)", KSPConvergedReasons[reason]);
  PetscCall(VecWAXPY(data->A0, 1, data->A_before, data->work_U));
  PetscFunctionReturn(0);
}

PetscErrorCode resolve_start(TS ts) {
  GeneralizedAlpha* data = generalized_alpha_data(ts);
  PetscReal speed;
  PetscBool good;

  PetscFunctionBegin;
  PetscCall(jacobian_at_rest(ts));
  PetscCall(VecNorm(data->V0, NORM_INFINITY, &speed));
  PetscCall(VecSet(data->a1, 0));
  if (speed > 0) {
    PetscCall(VecCopy(data->V0, data->V1));
    PetscCall(keep_resolved_part(ts, 1 / data->h, data->V1, nullptr, &good));
    if (good) PetscCall(acceleration_of_curvature(ts, data->V1, data->a1, &good));
    if (!good) PetscFunctionReturn(0);
  }
  PetscCall(VecCopy(data->A0, data->V1));
  PetscCall(keep_resolved_part(ts, 1, data->V1, data->a1, &good));
  if (good) PetscCall(VecCopy(data->V1, data->A0));
  PetscFunctionReturn(0);
}

PetscErrorCode resolve_jump(TS ts) {
  GeneralizedAlpha* data = generalized_alpha_data(ts);
  PetscBool good;

  PetscFunctionBegin;
  PetscCall(jacobian_at_rest(ts));
  PetscCall(jump_of_accelerations(data, data->V1));
  PetscCall(keep_resolved_part(ts, 1, data->V1, nullptr, &good));
  if (good) PetscCall(VecWAXPY(data->A0, 1, data->A_before, data->V1));
  PetscFunctionReturn(0);
}

PetscErrorCode resolve_jerk(TS ts) {
  GeneralizedAlpha* data = generalized_alpha_data(ts);
  KSPConvergedReason reason;

  PetscFunctionBegin;
  for (PetscInt twice = 0; twice < 2; ++twice) {
    PetscCall(leave_out_stiff(ts, data->h, data->jerk, &reason));
    PetscCheck(reason >= 0, PetscObjectComm((PetscObject)ts), PETSC_ERR_NOT_CONVERGED,
               "Consistent start: the linear solve failed (%s)", KSPConvergedReasons[reason]);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode resolved_share(TS ts, PetscReal* share) {
  GeneralizedAlpha* data = generalized_alpha_data(ts);
  KSPConvergedReason reason;
  PetscReal whole, lost;

  PetscFunctionBegin;
  PetscCall(VecWAXPY(data->work_U, -1, data->a0, data->A0));
  PetscCall(VecCopy(data->work_U, data->V1));
  PetscCall(inertia_norm(ts, 1, data->V1, &whole));
  PetscCall(leave_out_stiff(ts, 1, data->work_U, &reason));
  PetscCheck(reason >= 0, PetscObjectComm((PetscObject)ts), PETSC_ERR_NOT_CONVERGED,
             "Change of the step: the linear solve failed (%s)", KSPConvergedReasons[reason]);
  PetscCall(VecAXPY(data->V1, -1, data->work_U));
  PetscCall(inertia_norm(ts, 1, data->V1, &lost));
  *share = whole > 0 ? PetscMax(0, 1 - 5 * lost / whole) : 1;
  PetscFunctionReturn(0);
}

PetscErrorCode keep_resolved(TS ts, Vec U, PetscReal* reach) {
  GeneralizedAlpha* data = generalized_alpha_data(ts);
  KSPConvergedReason reason;
  PetscReal whole, lost, kept, coasting;

  PetscFunctionBegin;
  *reach = 0;
  PetscCall(jacobian_of_beginning(ts, 0, data->A0));
  PetscCall(VecWAXPY(data->work_U, -1, data->U0, U));
  PetscCall(VecPointwiseMult(data->work_U, data->work_U, data->dynamic));
  PetscCall(VecCopy(data->work_U, data->V1));
  PetscCall(inertia_norm(ts, data->shift_a, data->V1, &whole));
  PetscCall(leave_out_stiff(ts, data->shift_a, data->work_U, &reason));
  PetscCall(VecAXPY(data->V1, -1, data->work_U));
  PetscCall(inertia_norm(ts, data->shift_a, data->V1, &lost));
  if (reason < 0 || !(lost > 1e-3 * whole)) PetscFunctionReturn(0);
  PetscCall(inertia_norm(ts, data->shift_a, data->work_U, &kept));
  PetscCall(inertia_norm(ts, data->shift_a, data->V0, &coasting));
  PetscCall(VecWAXPY(U, 1, data->U0, data->work_U));
  *reach = 2 * kept + data->h * coasting;
  PetscFunctionReturn(0);
}

PetscErrorCode distance(TS ts, Vec U, PetscReal* far) {
  GeneralizedAlpha* data = generalized_alpha_data(ts);

  PetscFunctionBegin;
  PetscCall(VecWAXPY(data->work_U, -1, data->U0, U));
  PetscCall(VecPointwiseMult(data->work_U, data->work_U, data->dynamic));
  PetscCall(inertia_norm(ts, data->shift_a, data->work_U, far));
  PetscFunctionReturn(0);
}

}  // namespace floe::solve
