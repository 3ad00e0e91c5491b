#include "generalized_alpha_data.h"

namespace floe::solve {
namespace {

// Weights of A_0 - a_0 and of a_-1 - a_0 (of the step before) in a_1 - a_0.
//
//   linear     1/(af - am): the times of a_0 and A_0 are (af - am) h apart
//   quadratic  1/(af (af - am)) and 1/rho. With z = exp(h s) the scheme makes a = [(1 - af) z + af]/[(1 - am) z + am] A
//              of a smooth A; a_1 agrees to order h^2 then.
struct Extrapolation {
  PetscReal of_A, of_a;
};

// Squares, in the norm sqrt(sum |J_ii| q_i^2), of what an extrapolation adds to a_0, of a_0, A_0, and of q_0, where an
// attitude counts as 1 rad; of what the quadratic one adds to the linear one. Collective.
struct Sizes {
  PetscReal added, a, A, q, second;
};

PetscErrorCode measure_extrapolations(TS ts, Extrapolation linear, Extrapolation quadratic, Sizes* sizes) {
  GeneralizedAlpha* data = generalized_alpha_data(ts);
  PetscMPIInt ranks;
  double sums[5] = {0, 0, 0, 0, 0};

  PetscFunctionBegin;
  const Entries A(data->A0), a(data->a_used), before(data->a1), U(data->U0), weight(data->weight),
      attitude_rows(data->attitude_rows);
  for (PetscInt i = 0, n = local_size(data->a_used); i < n; ++i) {
    const PetscReal ahead = A[i] - a[i], added = linear.of_A * ahead;
    sums[0] += weight[i] * PetscSqr(added);
    sums[1] += weight[i] * PetscSqr(a[i]);
    sums[2] += weight[i] * PetscSqr(A[i]);
    sums[3] += weight[i] * (PetscSqr(U[i]) + attitude_rows[i]);
    sums[4] += weight[i] * PetscSqr(quadratic.of_A * ahead + quadratic.of_a * (before[i] - a[i]) - added);
  }
  PetscCallMPI(MPI_Comm_size(PetscObjectComm((PetscObject)ts), &ranks));
  if (ranks > 1)
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sums, 5, MPI_DOUBLE, MPI_SUM, PetscObjectComm((PetscObject)ts)));
  *sizes = {sums[0], sums[1], sums[2], sums[3], sums[4]};
  PetscFunctionReturn(0);
}

// The extrapolation that the step begins with: quadratic after two steps of one size where that changes the linear one
// by less than half of it; linear where it adds less than a_0 or A_0 is, and more to q_1 than some hundred times its
// round-off; else none (0, 0): differences are noise of stiff motions or of round-off then. Collective.
PetscErrorCode choose_extrapolation(TS ts, Extrapolation* chosen) {
  GeneralizedAlpha* data = generalized_alpha_data(ts);
  const PetscReal of_a = data->beta * data->h * data->h, ahead = data->alpha_f - data->alpha_m;
  const bool known = !data->fresh && data->equal_steps >= 2 && data->rho >= 0.5;
  const Extrapolation linear = {1 / ahead, 0};
  const Extrapolation quadratic = known ? Extrapolation{1 / (data->alpha_f * ahead), 1 / data->rho} : linear;
  Sizes of;

  PetscFunctionBegin;
  PetscCall(measure_extrapolations(ts, linear, quadratic, &of));
  const bool seen = of_a * PetscSqrtReal(of.added) > 100 * PETSC_MACHINE_EPSILON * PetscSqrtReal(of.q);
  *chosen = {0, 0};
  if (seen && of.added <= PetscMax(of.a, of.A)) *chosen = of.second < 0.25 * of.added ? quadratic : linear;
  PetscFunctionReturn(0);
}

}  // namespace

// Where Newton starts, into U1. Extrapolated: a_1 from the accelerations that the step begins with and, of steps of one
// size, from that of the step before. Plain: a_1 = a_0.
PetscErrorCode predict(TS ts, Guess guess) {
  GeneralizedAlpha* data = generalized_alpha_data(ts);
  const PetscReal of_a = data->beta * data->h * data->h;
  Extrapolation use = {0, 0};

  PetscFunctionBegin;
  PetscCall(VecWAXPY(data->U1, of_a, data->a_used, data->base_q));
  if (guess == Guess::extrapolated) PetscCall(choose_extrapolation(ts, &use));
  if (use.of_A == 0) PetscFunctionReturn(0);
  const Entries A(data->A0), a(data->a_used), before(data->a1);
  Changed U(data->U1);
  for (PetscInt i = 0, n = local_size(data->U1); i < n; ++i)
    U[i] += of_a * (use.of_A * (A[i] - a[i]) + use.of_a * (before[i] - a[i]));
  PetscFunctionReturn(0);
}

}  // namespace floe::solve
