#include <algorithm>

#include "generalized_alpha_data.h"

namespace floe::solve {
namespace {

struct Norms {
  PetscReal update, whole_update, increment, size, rotated;
};

// Weighted norms of Newton's last update, of the lesser of q_1 - q_0 and q_1 - q_0 - h v_0 (a steady motion is no
// measure of what a step solves for, nor is the speed of a stiff one), and of q_1, where an attitude counts as 1 rad
// (its entries count from a base that moves with it); `rotated`: with 1 rad for angles in the plane, too. Multipliers
// count in whole_update alone, by what their force moves: sum_j C_j^2 / |J_jj|, which is 1 / scale^2 of their row.
// Collective.
PetscErrorCode measure(GeneralizedAlpha* data, SNES snes, Norms* norms) {
  Vec U_vec, update_vec;
  SNESLineSearch line_search;
  PetscReal lambda;
  PetscMPIInt ranks;
  double sums[6] = {0, 0, 0, 0, 0, 0};

  PetscFunctionBegin;
  PetscCall(SNESGetSolution(snes, &U_vec));
  PetscCall(SNESGetSolutionUpdate(snes, &update_vec));
  PetscCall(SNESGetLineSearch(snes, &line_search));
  PetscCall(SNESLineSearchGetLambda(line_search, &lambda));
  const Entries U(U_vec), U0(data->U0), V0(data->V0), update(update_vec), weight(data->weight),
      attitude_rows(data->attitude_rows), rotation_rows(data->rotation_rows), dynamic(data->dynamic),
      scale(data->scale);
  for (PetscInt i = 0, n = local_size(U_vec); i < n; ++i) {
    sums[0] += weight[i] * PetscSqr(update[i]);
    sums[1] += weight[i] * PetscSqr(U[i] - U0[i]);
    sums[2] += weight[i] * PetscSqr(U[i] - U0[i] - data->h * V0[i]);
    sums[3] += weight[i] * (PetscSqr(U[i]) + attitude_rows[i]);
    sums[5] += weight[i] * (PetscSqr(U[i]) + rotation_rows[i]);
    if (dynamic[i] == 0) sums[4] += PetscSqr(update[i] / scale[i]);
  }
  PetscCallMPI(MPI_Comm_size(PetscObjectComm((PetscObject)snes), &ranks));
  if (ranks > 1)
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sums, 6, MPI_DOUBLE, MPI_SUM, PetscObjectComm((PetscObject)snes)));
  *norms = {lambda * PetscSqrtReal(sums[0]), lambda * PetscSqrtReal(sums[0] + sums[4]),
            PetscSqrtReal(PetscMin(sums[1], sums[2])), PetscSqrtReal(sums[3]), PetscSqrtReal(sums[5])};
  PetscFunctionReturn(0);
}

// The rate of convergence theta, and what a solve whose last update has that rate is away from its end,
// theta/(1 - theta) |d|.
struct Progress {
  PetscReal rate, left;
};

Progress progress(PetscReal rate, PetscReal update) {
  return {rate, rate < 1 ? rate / (1 - rate) * update : PETSC_MAX_REAL};
}

// For the first update of a solve: the rate seen last, in proportion to the update (Newton converges quadratically);
// unknown (1) if the Jacobian was new then and is not now.
Progress first_progress(GeneralizedAlpha* data, const Norms& norms) {
  const PetscReal update = norms.update;
  data->best = data->first_update = update;
  data->idle = data->growing = 0;
  if (!data->new_jacobian && !data->rate_of_old_jacobian) return {1, PETSC_MAX_REAL};
  const PetscReal larger = data->rate_update > 0 ? PetscMax(update / data->rate_update, 1) : 1;
  data->rate = PetscMin(2 * data->rate, 1);  // until it is measured again
  return progress(PetscMin(PetscPowReal(data->rate, 0.8) * larger, 1), norms.whole_update);
}

// The ratio of the last two updates, of q or of all unknowns, whichever is less: a first update of q is small where q
// was predicted well and multipliers were not, and multipliers that little determines go on wandering.
Progress later_progress(GeneralizedAlpha* data, const Norms& norms) {
  const PetscReal rate = data->update > 0 ? norms.update / data->update : 0;
  const PetscReal whole = data->whole_update > 0 ? norms.whole_update / data->whole_update : 0;
  const Progress of_q = progress(rate, norms.update), of_all = progress(whole, norms.whole_update);
  const Progress least = {PetscMin(rate, whole), PetscMin(of_q.left, of_all.left)};
  data->growing = least.rate > 2 ? data->growing + 1 : 0;
  data->idle = norms.update > 0.9 * data->best ? data->idle + 1 : 0;
  data->best = PetscMin(data->best, norms.update);
  data->rate = PetscMax(least.rate, PETSC_MACHINE_EPSILON);
  data->rate_update = data->first_update;
  data->rate_of_old_jacobian = data->formed ? PETSC_FALSE : PETSC_TRUE;
  return least;
}

// Whether Newton's method has left the neighbourhood of its start, so that it would converge to another solution: an
// update of ten times the first one and of the step's own size, or, with new Jacobians, a residual of a hundred times
// the first.
bool has_left(const GeneralizedAlpha* data, const Norms& norms, PetscInt lag, PetscReal residual) {
  return (norms.update > 10 * data->first_update && norms.update > 0.1 * norms.increment) ||
         (lag == 1 && residual > 100 * data->first_residual);
}

}  // namespace

// Converged when the error that is left is under rtol min(|q_1 - q_0|, |q_1 - q_0 - h v_0|) and slack, in the norm
// sqrt(sum |J_ii| q_i^2); the error after an update d with the rate theta is theta/(1 - theta) |d| (Hairer and Wanner,
// Solving Ordinary Differential Equations II, IV.8). Slack is 4 eps |q_1|, and less with a Jacobian kept from before,
// whose errors have the same sign step after step. What is left after a first update is measured in all unknowns: q may
// be predicted better than multipliers. Round-off: three updates in a row with a new Jacobian that are small and do not
// fall any more; a point away from the origin of its frame has a position of finite precision also where the frame's
// coordinates are near zero, hence 1 rad. A Jacobian kept from before is replaced when the rate is bad; when updates
// grow, it has led away from the solution, and solve() begins again without it.
PetscErrorCode newton_converged(SNES snes, PetscInt iteration, PetscReal, PetscReal, PetscReal residual,
                                SNESConvergedReason* reason, void* context) {
  GeneralizedAlpha* data = generalized_alpha_data(static_cast<TS>(context));
  PetscReal rtol;
  PetscInt lag;
  Norms norms;

  PetscFunctionBegin;
  *reason = SNES_CONVERGED_ITERATING;
  if (iteration == 0) {
    data->new_jacobian = data->formed = PETSC_FALSE;
    data->first_residual = residual;
    if (residual == 0) *reason = SNES_CONVERGED_FNORM_ABS;
    if (PetscIsInfOrNanReal(residual)) *reason = SNES_DIVERGED_FNORM_NAN;
    PetscFunctionReturn(0);
  }
  PetscCall(measure(data, snes, &norms));
  PetscCall(SNESGetTolerances(snes, nullptr, &rtol, nullptr, nullptr, nullptr));
  PetscCall(SNESGetLagJacobian(snes, &lag));
  if (data->new_jacobian) data->formed = PETSC_TRUE;
  const auto [rate, left] = iteration == 1 ? first_progress(data, norms) : later_progress(data, norms);
  const PetscReal floor = PETSC_MACHINE_EPSILON * norms.size, small = 1e3 * PETSC_MACHINE_EPSILON * norms.rotated;
  const PetscReal slack = (data->new_jacobian ? 4 : 0.01) * floor;
  if (PetscIsInfOrNanReal(norms.update) || PetscIsInfOrNanReal(residual)) {
    *reason = SNES_DIVERGED_FNORM_NAN;
  } else if ((iteration == 1 ? norms.whole_update : norms.update) <= 4 * floor ||
             left <= rtol * norms.increment + slack) {
    *reason = SNES_CONVERGED_SNORM_RELATIVE;
  } else if (iteration > 1 && rate > 1 && lag != 1) {
    *reason = SNES_DIVERGED_DTOL;
  } else if (iteration > 1 && rate > 0.25 && !data->new_jacobian) {
    renew_jacobian(snes, iteration);
    data->idle = data->growing = 0;
  } else if (data->idle >= 3 && norms.update <= PetscMax(0.1 * norms.increment, small)) {
    *reason = SNES_CONVERGED_SNORM_RELATIVE;
  } else if (norms.update > small && (data->growing >= 2 || has_left(data, norms, lag, residual))) {
    *reason = SNES_DIVERGED_DTOL;
  }
  data->update = norms.update;
  data->whole_update = norms.whole_update;
  data->new_jacobian = PETSC_FALSE;
  PetscFunctionReturn(0);
}

namespace {

// e = J^-1 shift_a M e0, e0 = h^2 (b - 1/6) (a_1 - a_0) - h^3/12 [v, A]: Newmark's error of q in the step, without what
// is stiff or normal to the constraints (there q is exact, and the estimate would be noise of the multipliers). Into
// work_U. M e0 is F(t, U, V, A + e0), for F is linear in A and F(t, U, V, A) = 0.
PetscErrorCode estimate_error(TS ts, KSPConvergedReason* reason) {
  GeneralizedAlpha* data = generalized_alpha_data(ts);
  const PetscReal h = data->h, factor = data->shift_a * h * h * (data->beta - 1. / 6);
  KSP ksp;

  PetscFunctionBegin;
  PetscCall(VecWAXPY(data->work_A, -1, data->a_used, data->a1));
  PetscCall(VecAYPX(data->work_A, factor, data->A1));
  PetscCall(add_bracket(ts, -data->shift_a * h * h * h / 12, data->V1, data->A1, data->work_V, data->work_A));
  PetscCall(TSComputeI2Function(ts, ts->ptime + h, data->U1, data->V1, data->work_A, data->work_F));
  {
    const Entries scale(data->scale), dynamic(data->dynamic);
    Changed rows(data->work_F);
    for (PetscInt i = 0, n = local_size(data->work_F); i < n; ++i) rows[i] *= dynamic[i] * scale[i];
  }
  PetscCall(SNESGetKSP(ts->snes, &ksp));
  PetscCall(solve_scaled(ts, data->work_F, data->work_U));
  PetscCall(KSPGetConvergedReason(ksp, reason));
  PetscFunctionReturn(0);
}

// The residuals within the step's interpolant, at x h, scaled rows; constraints into middle_U alone, the others into
// middle_V.
PetscErrorCode residuals_within(TS ts, PetscReal x) {
  GeneralizedAlpha* data = generalized_alpha_data(ts);

  PetscFunctionBegin;
  PetscCall(state_within(ts, data->h, x, data->middle_U, data->middle_V, data->middle_A));
  PetscCall(
      TSComputeI2Function(ts, ts->ptime + x * data->h, data->middle_U, data->middle_V, data->middle_A, data->work_F));
  const Entries scale(data->scale), dynamic(data->dynamic), rows(data->work_F);
  Changed constraints(data->middle_U), others(data->middle_V);
  for (PetscInt i = 0, n = local_size(data->work_F); i < n; ++i) {
    constraints[i] = (1 - dynamic[i]) * scale[i] * rows[i];
    others[i] = dynamic[i] * scale[i] * rows[i];
  }
  PetscFunctionReturn(0);
}

// e = J^-1 (0, c), c of residuals_within: what the constraints would change q by there. Of motions that drives
// prescribe q is exact at both ends whatever the step.
PetscErrorCode estimate_error_of_constraints(TS ts, KSPConvergedReason* reason) {
  GeneralizedAlpha* data = generalized_alpha_data(ts);
  KSP ksp;

  PetscFunctionBegin;
  PetscCall(solve_scaled(ts, data->middle_U, data->work_U));
  PetscCall(SNESGetKSP(ts->snes, &ksp));
  PetscCall(KSPGetConvergedReason(ksp, reason));
  PetscFunctionReturn(0);
}

// e = J^-1 shift_a M J^-1 (f, 0), f of residuals_within: what the forces would change q by there, without what is stiff
// or strongly damped. Loads that depend on sensors may begin and end within a step.
PetscErrorCode estimate_error_of_loads(TS ts, KSPConvergedReason* reason) {
  GeneralizedAlpha* data = generalized_alpha_data(ts);
  KSP ksp;

  PetscFunctionBegin;
  PetscCall(SNESGetKSP(ts->snes, &ksp));
  PetscCall(solve_scaled(ts, data->middle_V, data->work_U));
  PetscCall(KSPGetConvergedReason(ksp, reason));
  if (*reason < 0) PetscFunctionReturn(0);
  PetscCall(VecPointwiseMult(data->work_U, data->work_U, data->dynamic));
  PetscCall(VecWAXPY(data->work_A, data->shift_a, data->work_U, data->A1));
  PetscCall(TSComputeI2Function(ts, ts->ptime + data->h, data->U1, data->V1, data->work_A, data->work_F));
  PetscCall(VecPointwiseMult(data->work_F, data->work_F, data->scale));
  PetscCall(VecPointwiseMult(data->work_F, data->work_F, data->dynamic));
  PetscCall(solve_scaled(ts, data->work_F, data->work_U));
  PetscCall(KSPGetConvergedReason(ksp, reason));
  PetscFunctionReturn(0);
}

// The square of the mass norm of the error in work_U, of this rank; infinite where the equations cannot be evaluated.
double square_of_error(const GeneralizedAlpha* data, KSPConvergedReason reason) {
  double square = 0;
  const Entries e(data->work_U), mass(data->mass), dynamic(data->dynamic);
  for (PetscInt i = 0, n = local_size(data->U1); i < n; ++i) square += dynamic[i] * mass[i] * PetscSqr(e[i]);
  return reason < 0 || PetscIsNanReal(square) ? PETSC_INFINITY : square;
}

// Squares of errors within the step, of this rank: of the constraints in its middle, and, where loads depend on
// sensors, of the loads at its three quarters.
PetscErrorCode square_errors_within(TS ts, double* of_constraints, double* of_loads) {
  GeneralizedAlpha* data = generalized_alpha_data(ts);
  KSPConvergedReason reason;

  PetscFunctionBegin;
  for (const int quarter : {1, 2, 3}) {
    if (quarter != 2 && !data->state_loads) continue;
    PetscCall(residuals_within(ts, 0.25 * quarter));
    if (quarter == 2) {
      PetscCall(estimate_error_of_constraints(ts, &reason));
      *of_constraints = square_of_error(data, reason);
    }
    if (data->state_loads) {
      PetscCall(estimate_error_of_loads(ts, &reason));
      of_loads[quarter - 1] = square_of_error(data, reason);
    }
  }
  PetscFunctionReturn(0);
}

// The distance that a step from rest without a force is judged by: of the longest attempt that resolves the load, for
// with one that grows as t^p distances fall with the power 2 + p of the step from each attempt to the next: at the
// start of the motion twice in a row, since a load that alternates does so once by chance. One that begins more steeply
// (p < 0.4) is not waited for. The distance counts until the end of that attempt: by then the motion has gone it, or it
// was that of a load that the attempt did not resolve.
void note_start(TS ts) {
  GeneralizedAlpha* data = generalized_alpha_data(ts);
  constexpr PetscInt most_attempts = 8;
  const PetscReal ratio = data->start_h / data->h;
  const bool falls = data->start_tried > 0 && ratio * ratio * ratio * data->reach_tried <= 4 * data->start_tried;
  data->start_falls = falls ? data->start_falls + 1 : 0;
  if (++data->start_attempts > most_attempts)
    data->start_falls = 2;
  else if (!falls)
    data->start_reach = data->reach_tried, data->start_until = ts->ptime + data->h;
  data->start_tried = data->reach_tried;
  data->start_h = data->h;
}

}  // namespace

// Error of q in the step over rtol times the greatest distance of q from where the run began, both in the norm sqrt(sum
// M_ii q_i^2): no unit and no atol enters. The distance counts at least as 1e-9 of q: what moves less, as about an
// equilibrium, moves by round-off. -1 (not known) while nothing has moved. In the first step from rest without a force
// the distance is of the size of the error whatever the step: that of a longer attempt counts (note_start). The power
// of h in the estimate is 3, which is what TSAdapt calls order (the scheme is of order 2).
//
// It is that at the end or, if larger, that of the constraints in the middle. A step is also refused for that of loads
// of sensors at its quarters where this is above the tolerance and ten times the others, which do not see it then; it
// does not decide on the size of the next step: of vibrations that steps hardly resolve it is as large as the others,
// and would make steps vary.
PetscErrorCode local_error(TS ts, NormType, PetscInt* order, PetscReal* error) {
  GeneralizedAlpha* data = generalized_alpha_data(ts);
  constexpr PetscReal least = 1e-9, hidden = 10;
  enum { of_end, of_constraints, of_loads, distance = of_loads + 3, size, count };
  double sums[count] = {};
  KSPConvergedReason reason;

  PetscFunctionBegin;
  PetscCall(estimate_error(ts, &reason));
  PetscCheck(reason >= 0, PetscObjectComm((PetscObject)ts), PETSC_ERR_NOT_CONVERGED,
             "Error of the step: the linear solve failed (%s)", KSPConvergedReasons[reason]);
  sums[of_end] = square_of_error(data, reason);
  PetscCall(square_errors_within(ts, &sums[of_constraints], &sums[of_loads]));
  {
    const Entries U1(data->U1), origin(data->origin), mass(data->mass), dynamic(data->dynamic);
    for (PetscInt i = 0, n = local_size(data->U1); i < n; ++i) {
      sums[distance] += dynamic[i] * mass[i] * PetscSqr(U1[i] - origin[i]);
      sums[size] += dynamic[i] * mass[i] * PetscSqr(U1[i]);
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sums, count, MPI_DOUBLE, MPI_SUM, PetscObjectComm((PetscObject)ts)));
  data->reach_tried = PetscSqrtReal(sums[distance]);
  const PetscReal round_off = least * PetscSqrtReal(sums[size]);
  const bool rests = data->from_rest && !(data->reach_tried > round_off);  // the load begins later
  if (data->from_rest && !rests) note_start(ts);
  const PetscReal moved = PetscMax(data->reach, data->reach_tried);
  const PetscReal expected = data->from_rest || ts->ptime < data->start_until ? data->start_reach : 0;
  const PetscReal reach = PetscMax(PetscMax(moved, expected), round_off);
  const PetscReal seen = PetscSqrtReal(PetscMax(sums[of_end], sums[of_constraints])),
                  unseen = PetscSqrtReal(*std::max_element(sums + of_loads, sums + distance));
  const bool refused = unseen > hidden * seen && unseen > ts->rtol * reach;
  *error = reach > 0 ? (refused ? unseen : seen) / (ts->rtol * reach) : -1;
  if (rests)
    *error = -1;
  else if (data->from_rest && ts->steps == 0 && data->start_falls < 2)
    *error = PetscMax(*error, 1e3);
  *order = 3;
  PetscFunctionReturn(0);
}

PetscErrorCode measure_event_error(TS ts) {
  GeneralizedAlpha* data = generalized_alpha_data(ts);
  double sums[3] = {0, 0, 0};
  PetscBool fixed;
  KSPConvergedReason reason;

  PetscFunctionBegin;
  data->event_error = 0;
  PetscCall(PetscObjectTypeCompare((PetscObject)ts->adapt, TSADAPTNONE, &fixed));
  if (!fixed || passed_since_event(ts, data->h)) PetscFunctionReturn(0);
  PetscCall(estimate_error(ts, &reason));
  if (reason < 0) PetscFunctionReturn(0);
  {
    const Entries e(data->work_U), U0(data->U0), U1(data->U1), origin(data->origin), mass(data->mass),
        dynamic(data->dynamic);
    for (PetscInt i = 0, n = local_size(data->U1); i < n; ++i) {
      sums[0] += dynamic[i] * mass[i] * PetscSqr(e[i]);
      sums[1] += dynamic[i] * mass[i] * PetscSqr(U1[i] - U0[i]);
      sums[2] += dynamic[i] * mass[i] * PetscSqr(U1[i] - origin[i]);
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sums, 3, MPI_DOUBLE, MPI_SUM, PetscObjectComm((PetscObject)ts)));
  const PetscReal path = PetscSqrtReal(PetscMax(sums[1], 1e-8 * sums[2]));
  if (path > 0) data->event_error = PetscSqrtReal(sums[0]) / path;
  PetscFunctionReturn(0);
}

}  // namespace floe::solve
