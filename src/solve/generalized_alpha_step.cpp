#include <petsc/private/snesimpl.h>

#include <utility>

#include "generalized_alpha_data.h"
#include "simplified_newton.h"

namespace floe::solve {
namespace {

// The time that the step under way ends at.
PetscReal end_time(TS ts) { return ts->ptime + generalized_alpha_data(ts)->h; }

// The state becomes the step's beginning. Multipliers have no rates, whatever the user's V holds there.
PetscErrorCode begin(TS ts) {
  GeneralizedAlpha* data = generalized_alpha_data(ts);

  PetscFunctionBegin;
  PetscCall(rebase(ts));
  PetscCall(VecCopy(ts->vec_sol, data->U0));
  PetscCall(VecPointwiseMult(data->V0, ts->vec_dot, data->dynamic));
  std::swap(data->A0, data->A1);
  std::swap(data->a0, data->a1);
  data->h_a0 = data->h;
  ++data->equal_steps;
  data->fresh = PETSC_FALSE;
  PetscCall(note_rest(ts));
  PetscFunctionReturn(0);
}

// a_n and v_n as a first step needs them (and, with constraints, one of another size than the last), so that the
// numerical solution is smooth from the start.
//
// The smooth solution of the scheme has a_n = A(t_n + (am - af) h); normal to the constraints, where q is exact,
// summing q_1 - q_0 over a step shows v_n = v(t_n) + c h^2 A', c = 1/6 - b + (af - am)/2 (and h^2 [v, A]/12 of
// rotations). Starting with a_0 = A_0 or v_0 = v(t_0) leaves a transient of O(h) in the multipliers. Only the part of
// A' that the step resolves counts: of stiff motions h A' would be noise greater than A.
void fresh_rates(GeneralizedAlpha* data) {
  const Entries v(data->V0), A(data->A0), jerk(data->jerk), normal(data->normal);
  Changed a_used(data->a_used), v_used(data->work_V);
  const PetscReal h = data->h, shift = data->alpha_f - data->alpha_m;
  for (PetscInt i = 0, n = local_size(data->U0); i < n; ++i) {
    a_used[i] = A[i] - h * shift * jerk[i];
    v_used[i] = v[i] + h * h * normal[i];
  }
}

// Without constraints: a_n - A_n is proportional to the step and follows a change of h, up to twice its size.
void later_rates(GeneralizedAlpha* data) {
  const Entries v(data->V0), A(data->A0), a(data->a0);
  Changed a_used(data->a_used), v_used(data->work_V);
  const PetscReal ratio = PetscMin(data->h / data->h_a0, 2);
  for (PetscInt i = 0, n = local_size(data->U0); i < n; ++i) {
    a_used[i] = ratio == 1 ? a[i] : A[i] + ratio * (a[i] - A[i]);
    v_used[i] = v[i];
  }
}

// Shifts, scales and the constants in a_1(q_1), v_1(a_1), A_1(a_1) for a step h.
PetscErrorCode prepare(TS ts, PetscReal h) {
  GeneralizedAlpha* data = generalized_alpha_data(ts);
  const PetscReal beta = data->beta, gamma = data->gamma, alpha_m = data->alpha_m, alpha_f = data->alpha_f;

  PetscFunctionBegin;
  set_step(data, h);
  if (PetscAbsReal(h - data->h_a0) > 1e-9 * data->h_a0) data->equal_steps = 0;
  if (data->fresh && PetscAbsReal(h - data->h_start) > 1e-6 * data->h_start)
    PetscCall(data->smoothed ? smooth_rates(ts) : start_consistently(ts));
  else if (!data->fresh && data->multipliers && PetscAbsReal(h - data->h_a0) > 1e-6 * data->h_a0)
    PetscCall(smooth_rates(ts));
  else if (PetscAbsReal(h - data->h_scale) > 0.05 * data->h_scale)
    PetscCall(set_scales(ts));
  if (data->fresh)
    fresh_rates(data);
  else
    later_rates(data);
  const Entries U0(data->U0), v(data->work_V), A(data->A0), a(data->a_used);
  Changed base_q(data->base_q), base_v(data->base_v), base_A(data->base_A);
  for (PetscInt i = 0, n = local_size(data->U0); i < n; ++i) {
    base_q[i] = U0[i] + h * v[i] + h * h * (0.5 - beta) * a[i];
    base_v[i] = v[i] + h * (1 - gamma) * a[i];
    base_A[i] = (alpha_m * a[i] - alpha_f * A[i]) / (1 - alpha_f);
  }
  PetscFunctionReturn(0);
}

// V1, A1 and, if wanted, a1 that belong to U.
void set_rates(GeneralizedAlpha* data, Vec U_vec, bool auxiliary) {
  const Entries U(U_vec), dynamic(data->dynamic), base_q(data->base_q), base_v(data->base_v), base_A(data->base_A);
  Changed V(data->V1), A(data->A1), a(data->a1);
  const PetscReal h = data->h, of_q = 1 / (data->beta * h * h), of_a = (1 - data->alpha_m) / (1 - data->alpha_f);
  for (PetscInt i = 0, n = local_size(data->U0); i < n; ++i) {
    const PetscReal a1 = dynamic[i] * (U[i] - base_q[i]) * of_q;
    V[i] = base_v[i] + h * data->gamma * a1;
    A[i] = base_A[i] + of_a * a1;
    if (auxiliary) a[i] = a1;
  }
}

// SNES types that test no convergence (ksponly) may return what is no number, or runs out of numbers: a step that did
// not converge.
PetscErrorCode refuse_not_finite(TS ts) {
  GeneralizedAlpha* data = generalized_alpha_data(ts);
  PetscBool tested;
  PetscReal sizes[2];

  PetscFunctionBegin;
  PetscCall(PetscObjectTypeCompare((PetscObject)ts->snes, simplified_newton, &tested));
  if (tested || ts->snes->reason < 0) PetscFunctionReturn(0);
  set_rates(data, data->U1, false);
  PetscCall(VecNorm(data->U1, NORM_2, &sizes[0]));
  PetscCall(VecNorm(data->V1, NORM_2, &sizes[1]));
  if (!(sizes[0] < beyond_numbers && sizes[1] < beyond_numbers))
    PetscCall(SNESSetConvergedReason(ts->snes, SNES_DIVERGED_FNORM_NAN));
  PetscFunctionReturn(0);
}

PetscErrorCode newton(TS ts, SNESConvergedReason* reason) {
  PetscInt iterations, linear;

  PetscFunctionBegin;
  PetscCall(solve_again(ts->snes, generalized_alpha_data(ts)->U1));
  PetscCall(refuse_not_finite(ts));
  PetscCall(SNESGetIterationNumber(ts->snes, &iterations));
  PetscCall(SNESGetLinearSolveIterations(ts->snes, &linear));
  PetscCall(SNESGetConvergedReason(ts->snes, reason));
  ts->snes_its += iterations;
  ts->ksp_its += linear;
  PetscFunctionReturn(0);
}

// From where the step would lead without motions that it does not resolve, which after a sudden force at a node are
// too far away for convergence. A solution that is farther away than `reach` is not that of the motion.
PetscErrorCode newton_from_resolved(TS ts, SNESConvergedReason* reason) {
  GeneralizedAlpha* data = generalized_alpha_data(ts);
  PetscReal reach, far;

  PetscFunctionBegin;
  PetscCall(predict(ts, Guess::plain));
  PetscCall(keep_resolved(ts, data->U1, &reach));
  renew_jacobian(ts->snes, 0);
  if (reach == 0) data->unresolved = PETSC_FALSE;
  if (reach == 0) PetscFunctionReturn(0);
  PetscCall(newton(ts, reason));
  if (*reason < 0) PetscFunctionReturn(0);
  PetscCall(distance(ts, data->U1, &far));
  if (far <= reach) data->unresolved = PETSC_TRUE;
  if (far <= reach) PetscFunctionReturn(0);
  *reason = SNES_DIVERGED_DTOL;
  PetscCall(SNESSetConvergedReason(ts->snes, *reason));
  PetscFunctionReturn(0);
}

// Newton begins with a Jacobian whose lag has passed and does not run into the lag on the way: a new Jacobian at the
// beginning makes two iterations of a step, one before the last saves none. What fails with a Jacobian kept from before
// is tried again with a new one in every iteration.
PetscErrorCode newton_from_extrapolated(TS ts, PetscInt lag, SNESConvergedReason* reason) {
  const bool kept = lag > 1 && ts->snes->lagjac_persist;

  PetscFunctionBegin;
  if (kept && ts->snes->jac_iter >= lag) renew_jacobian(ts->snes, 0);
  if (kept) ts->snes->lagjacobian = PETSC_MAX_INT;
  PetscCall(predict(ts, Guess::extrapolated));
  PetscCall(newton(ts, reason));
  ts->snes->lagjacobian = lag;
  if (*reason >= 0 || lag == 1) PetscFunctionReturn(0);
  ts->snes->lagjacobian = 1;
  renew_jacobian(ts->snes, 0);
  PetscCall(predict(ts, Guess::plain));
  PetscCall(newton(ts, reason));
  PetscFunctionReturn(0);
}

// While there are motions that the step does not resolve, from the step where Newton's method fails because of them on,
// only solutions near the resolved motion are accepted.
PetscErrorCode solve(TS ts) {
  GeneralizedAlpha* data = generalized_alpha_data(ts);
  const PetscInt lag = ts->snes->lagjacobian;
  SNESConvergedReason reason = SNES_DIVERGED_DTOL;

  PetscFunctionBegin;
  if (!ts->snes->lagjac_persist) ts->snes->jac_iter = 0;
  if (!ts->snes->lagpre_persist) ts->snes->pre_iter = 0;
  const PetscBool before = data->unresolved;
  if (before) {
    ts->snes->lagjacobian = 1;
    PetscCall(newton_from_resolved(ts, &reason));
    ts->snes->lagjacobian = lag;
  }
  if (!data->unresolved) PetscCall(newton_from_extrapolated(ts, lag, &reason));
  if (!before && reason < 0) {
    ts->snes->lagjacobian = 1;
    PetscCall(newton_from_resolved(ts, &reason));
  }
  ts->snes->lagjacobian = lag;
  if (reason < 0) renew_jacobian(ts->snes, 0);
  PetscFunctionReturn(0);
}

// A step that ends where the motion does, or past it by round-off, ends there. TSSolve sees to that with its first step
// only, so that a motion that is taken up before its last step would take another one than the motion that went on.
void end_in_time(TS ts) {
  const PetscReal left = ts->max_time - ts->ptime;
  if (ts->exact_final_time == TS_EXACTFINALTIME_MATCHSTEP && left > 0 && ts->time_step > (1 - 1e-9) * left)
    ts->time_step = left;
}

// An adaptive step that would change by little is kept: constant steps are what the scheme likes best, and a Jacobian
// may serve longer. Not near a time that is to be met.
PetscReal keep_if_close(TS ts, PetscReal next) {
  const PetscReal h = ts->time_step;
  const PetscReal goal = ts->tspan ? ts->tspan->span_times[ts->tspan->spanctr] : ts->max_time;
  const bool free_to_choose = goal - ts->ptime > 4 * PetscMax(h, next);
  return free_to_choose && next > 0.95 * h && next < 1.25 * h ? h : next;
}

// One attempt; *accepted tells whether ts->vec_sol and ts->vec_dot now hold the step's end.
PetscErrorCode attempt(TS ts, PetscReal* next, PetscBool* accepted) {
  GeneralizedAlpha* data = generalized_alpha_data(ts);

  PetscFunctionBegin;
  if (ts->ptime + ts->time_step == ts->ptime) {
    PetscCall(PetscInfo(ts, "Step %" PetscInt_FMT ": too small to change the time\n", ts->steps));
    ts->reason = TS_DIVERGED_STEP_REJECTED;
    *accepted = PETSC_FALSE;
    PetscFunctionReturn(0);
  }
  PetscCall(prepare(ts, ts->time_step));
  PetscCall(TSPreStage(ts, end_time(ts)));
  PetscCall(solve(ts));
  PetscCall(TSPostStage(ts, end_time(ts), 0, &data->U1));
  PetscCall(TSAdaptCheckStage(ts->adapt, ts, end_time(ts), data->U1, accepted));
  if (!*accepted) PetscFunctionReturn(0);
  set_rates(data, data->U1, true);
  PetscCall(VecCopy(data->U1, ts->vec_sol));
  PetscCall(VecCopy(data->V1, ts->vec_dot));
  PetscCall(TSAdaptChoose(ts->adapt, ts, ts->time_step, nullptr, next, accepted));
  if (!*accepted) {
    PetscCall(roll_back(ts));
    ts->time_step = *next;
  }
  PetscFunctionReturn(0);
}

// Whether the step needs a consistent start. TS asks for one, too, where its post-step function took the step back,
// which changed nothing: then the rates that the step began with stand, and follow its new size.
PetscErrorCode starts_again(TS ts, PetscBool* again) {
  GeneralizedAlpha* data = generalized_alpha_data(ts);
  PetscBool same_U, same_V;

  PetscFunctionBegin;
  *again = ts->steprestart || !data->started ? PETSC_TRUE : PETSC_FALSE;
  if (!*again || !data->started || !ts->steprollback) PetscFunctionReturn(0);
  PetscCall(VecEqual(ts->vec_sol, data->U0, &same_U));
  PetscCall(VecEqual(ts->vec_dot, data->V0, &same_V));
  if (same_U && same_V) *again = PETSC_FALSE;
  PetscFunctionReturn(0);
}

}  // namespace

PetscErrorCode step(TS ts) {
  GeneralizedAlpha* data = generalized_alpha_data(ts);
  PetscInt rejections = 0;
  PetscReal next;
  PetscBool accepted = PETSC_TRUE, again;

  PetscFunctionBegin;
  end_in_time(ts);
  next = ts->time_step;
  if (!ts->steprollback) PetscCall(begin(ts));
  PetscCall(starts_again(ts, &again));
  if (again && data->started) PetscCall(note_event(ts));
  if (again) PetscCall(start_consistently(ts));
  do {
    PetscCall(attempt(ts, &next, &accepted));
    if (accepted) {
      data->reach = PetscMax(data->reach, data->reach_tried);
      PetscCall(measure_event_error(ts));
      next = keep_if_close(ts, next);
      ts->ptime += ts->time_step;
      ts->time_step = next;
      break;
    }
    ts->reject++;
    if (!ts->reason && ++rejections > ts->max_reject && ts->max_reject >= 0) {
      ts->reason = TS_DIVERGED_STEP_REJECTED;
      PetscCall(PetscInfo(ts, "Step %" PetscInt_FMT ": rejected %" PetscInt_FMT " times\n", ts->steps, rejections));
    }
  } while (!ts->reason);
  PetscFunctionReturn(0);
}

PetscErrorCode roll_back(TS ts) {
  GeneralizedAlpha* data = generalized_alpha_data(ts);

  PetscFunctionBegin;
  PetscCall(VecCopy(data->U0, ts->vec_sol));
  PetscCall(VecCopy(data->V0, ts->vec_dot));
  PetscCall(VecCopy(data->A0, data->A1));
  data->equal_steps = 0;  // a1 is that of the step that was taken back
  PetscFunctionReturn(0);
}

// Cubic Hermite for q (error O(h^4) of the scheme's own path), linear for the multipliers. work_V: dU/dt at the end.
static PetscErrorCode place_within(TS ts, PetscReal h, PetscReal x, Vec U_vec) {
  GeneralizedAlpha* data = generalized_alpha_data(ts);

  PetscFunctionBegin;
  PetscCall(VecCopy(data->V1, data->work_V));
  PetscCall(add_bracket(ts, 0.5, data->U1, data->V1, data->work_U, data->work_V));
  const Entries U0(data->U0), V0(data->V0), U1(data->U1), V1(data->work_V), dynamic(data->dynamic);
  Changed U(U_vec);
  for (PetscInt i = 0, n = local_size(data->U0); i < n; ++i) {
    const PetscReal to_end = dynamic[i] != 0 ? x * x * (3 - 2 * x) : x;
    U[i] = U0[i] + to_end * (U1[i] - U0[i]) + h * x * (1 - x) * ((1 - x) * V0[i] - x * V1[i]);
  }
  PetscFunctionReturn(0);
}

// Rates: quadratic between V0 and V1, their second derivative by the change of the auxiliary accelerations. A itself
// alternates from step to step where motions are damped much faster than a step; its mean, a, hardly does.
PetscErrorCode state_within(TS ts, PetscReal h, PetscReal x, Vec U, Vec V_vec, Vec A_vec) {
  GeneralizedAlpha* data = generalized_alpha_data(ts);

  PetscFunctionBegin;
  PetscCall(place_within(ts, h, x, U));
  const Entries V0(data->V0), V1(data->V1), A0(data->A0), A1(data->A1), dynamic(data->dynamic);
  const Entries a0(data->a_used), a1(data->a1);
  Changed V(V_vec), A(A_vec);
  for (PetscInt i = 0, n = local_size(V_vec); i < n; ++i) {
    V[i] = dynamic[i] * (V0[i] + x * (V1[i] - V0[i]) - h * x * (1 - x) * (a1[i] - a0[i]) / 2);
    A[i] = A0[i] + x * (A1[i] - A0[i]);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode interpolate(TS ts, PetscReal t, Vec U) {
  PetscFunctionBegin;
  const PetscReal h = ts->ptime - ts->ptime_prev;
  if (h == 0)
    PetscCall(VecCopy(ts->vec_sol, U));
  else
    PetscCall(place_within(ts, h, (t - ts->ptime_prev) / h, U));
  PetscFunctionReturn(0);
}

PetscErrorCode interpolate_all(TS ts, PetscReal t, Vec U, Vec V, Vec A) {
  PetscFunctionBegin;
  const PetscReal h = ts->ptime - ts->ptime_prev;
  if (h == 0) {
    PetscCall(VecCopy(ts->vec_sol, U));
    PetscCall(VecCopy(ts->vec_dot, V));
    PetscCall(VecCopy(generalized_alpha_data(ts)->A1, A));
  } else {
    PetscCall(state_within(ts, h, (t - ts->ptime_prev) / h, U, V, A));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode form_function(SNES, Vec U, Vec F, TS ts) {
  GeneralizedAlpha* data = generalized_alpha_data(ts);

  PetscFunctionBegin;
  set_rates(data, U, false);
  PetscCall(TSComputeI2Function(ts, end_time(ts), U, data->V1, data->A1, F));
  const Entries scale(data->scale);
  Changed scaled(F);
  for (PetscInt i = 0, n = local_size(F); i < n; ++i) scaled[i] *= scale[i];
  PetscFunctionReturn(0);
}

// SNES has evaluated the function at U before: V1 and A1 belong to U.
PetscErrorCode form_jacobian(SNES, Vec U, Mat J, Mat P, TS ts) {
  GeneralizedAlpha* data = generalized_alpha_data(ts);

  PetscFunctionBegin;
  PetscCall(TSComputeI2Jacobian(ts, end_time(ts), U, data->V1, data->A1, data->shift_v, data->shift_a, J, P));
  PetscCall(scale_jacobian(ts, P));
  if (J != P) PetscCall(MatDiagonalScale(J, data->scale, data->two_sided ? data->column : nullptr));
  PetscCall(VecCopy(U, data->tangent_U));
  PetscCall(VecCopy(data->V1, data->tangent_V));
  PetscCall(VecCopy(data->A1, data->tangent_A));
  data->tangent_t = end_time(ts);
  data->tangent_shift_v = data->shift_v;
  data->tangent_shift_a = data->shift_a;
  data->new_jacobian = PETSC_TRUE;
  PetscFunctionReturn(0);
}

}  // namespace floe::solve
