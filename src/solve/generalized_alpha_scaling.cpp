#include <petsc/private/snesimpl.h>

#include <vector>

#include "generalized_alpha_data.h"
#include "simplified_newton.h"

// Rows are scaled: a dense LU with partial pivoting compares entries of a column, which row scaling gives one unit. A
// sparse one may compare those of a row (PETSc hands KLU the transpose, and leaves KLU's own scaling out): there the
// unknowns are scaled likewise, and what it solves for is scaled back. With w_i = |K_ii| + shift_a M_ii (the Jacobian's
// diagonal, an energy per unit of q_i squared)
//   dynamic row     1 / sqrt(w_i)
//   constraint row  1 / sqrt(sum_j C_j^2 / w_j)
// the dynamic rows get a unit diagonal in the variables sqrt(w_j) q_j and the constraint rows unit length, at any step
// size and in any units. K_ii, M_ii and C_j are those of the start.

namespace floe::solve {
namespace {

struct Row {
  std::vector<PetscInt> columns;
  std::vector<PetscScalar> values;
};

PetscErrorCode owned_constraint_rows(GeneralizedAlpha* data, Mat J, std::vector<PetscInt>& local, Row& entries,
                                     std::vector<size_t>& ends) {
  PetscInt first;

  PetscFunctionBegin;
  PetscCall(VecGetOwnershipRange(data->dynamic, &first, nullptr));
  const Entries dynamic(data->dynamic);
  for (PetscInt i = 0, n = local_size(data->dynamic); i < n; ++i) {
    if (dynamic[i] != 0) continue;
    PetscInt count;
    const PetscInt* columns;
    const PetscScalar* values;
    PetscCall(MatGetRow(J, first + i, &count, &columns, &values));
    entries.columns.insert(entries.columns.end(), columns, columns + count);
    entries.values.insert(entries.values.end(), values, values + count);
    PetscCall(MatRestoreRow(J, first + i, &count, &columns, &values));
    local.push_back(i);
    ends.push_back(entries.columns.size());
  }
  PetscFunctionReturn(0);
}

// w of the given columns, whoever owns them. Collective.
PetscErrorCode gather_weights(Vec weight, const std::vector<PetscInt>& columns, std::vector<PetscScalar>& gathered) {
  IS wanted;
  Vec here;
  VecScatter scatter;
  const auto count = static_cast<PetscInt>(columns.size());

  PetscFunctionBegin;
  gathered.resize(columns.size());
  PetscCall(ISCreateGeneral(PetscObjectComm((PetscObject)weight), count, columns.data(), PETSC_COPY_VALUES, &wanted));
  PetscCall(VecCreateSeqWithArray(PETSC_COMM_SELF, 1, count, gathered.data(), &here));
  PetscCall(VecScatterCreate(weight, wanted, here, nullptr, &scatter));
  PetscCall(VecScatterBegin(scatter, weight, here, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecScatterEnd(scatter, weight, here, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecScatterDestroy(&scatter));
  PetscCall(VecDestroy(&here));
  PetscCall(ISDestroy(&wanted));
  PetscFunctionReturn(0);
}

// row = 1 / sqrt(sum_j C_j^2 shift_a / w_j): nearly free of the step size. Needs weight.
PetscErrorCode measure_constraint_rows(GeneralizedAlpha* data, Mat J) {
  std::vector<PetscInt> local;
  std::vector<PetscScalar> weights;
  std::vector<size_t> ends;
  Row entries;

  PetscFunctionBegin;
  PetscCall(owned_constraint_rows(data, J, local, entries, ends));
  PetscCall(gather_weights(data->weight, entries.columns, weights));
  Changed row(data->row);
  for (size_t r = 0, k = 0; r < local.size(); ++r) {
    PetscReal sum = 0;
    for (; k < ends[r]; ++k)
      if (weights[k] > 0) sum += PetscSqr(entries.values[k]) * data->shift_a / weights[k];
    row[local[r]] = sum > 0 ? 1 / PetscSqrtReal(sum) : 1;
  }
  PetscFunctionReturn(0);
}

// Relative to the maximum weight.
constexpr PetscReal round_off = 1e-20;

// Of unknowns without mass (but for round-off of the sums of several ranks) whose stiffness is round-off (multipliers
// of axes that accompany a body times the curvature of their constraints) it is zero: their rows, and constraint rows
// that see them, would be scaled by its square root. The limit alone would depend on units. Collective.
PetscErrorCode weigh(GeneralizedAlpha* data) {
  PetscReal greatest;

  PetscFunctionBegin;
  const Entries dynamic(data->dynamic), stiffness(data->stiffness), mass(data->mass);
  {
    Changed weight(data->weight);
    for (PetscInt i = 0, n = local_size(data->weight); i < n; ++i)
      weight[i] = dynamic[i] * (stiffness[i] + data->shift_a * mass[i]);
  }
  PetscCall(VecMax(data->weight, nullptr, &greatest));
  Changed weight(data->weight);
  for (PetscInt i = 0, n = local_size(data->weight); i < n; ++i)
    if (data->shift_a * mass[i] <= 1e-12 * stiffness[i] && weight[i] <= round_off * greatest) weight[i] = 0;
  PetscFunctionReturn(0);
}

}  // namespace

PetscErrorCode measure_scales(TS ts, Mat* inertia) {
  GeneralizedAlpha* data = generalized_alpha_data(ts);
  Mat J, P;

  PetscFunctionBegin;
  PetscCall(SNESGetJacobian(ts->snes, &J, &P, nullptr, nullptr));
  PetscCall(TSComputeI2Jacobian(ts, ts->ptime, data->U0, data->V0, data->A0, 0, 0, J, P));
  PetscCall(MatGetDiagonal(P, data->stiffness));
  if (inertia) PetscCall(MatDuplicate(P, MAT_COPY_VALUES, inertia));
  PetscCall(TSComputeI2Jacobian(ts, ts->ptime, data->U0, data->V0, data->A0, 0, data->shift_a, J, P));
  PetscCall(MatGetDiagonal(P, data->mass));
  PetscCall(VecAXPY(data->mass, -1, data->stiffness));
  PetscCall(VecScale(data->mass, 1 / data->shift_a));
  PetscCall(VecAbs(data->mass));
  PetscCall(VecAbs(data->stiffness));
  if (inertia) {
    PetscCall(MatAYPX(*inertia, -1, P, SAME_NONZERO_PATTERN));
    PetscCall(MatScale(*inertia, 1 / data->shift_a));
  }
  PetscCall(weigh(data));
  PetscCall(measure_constraint_rows(data, P));
  PetscFunctionReturn(0);
}

PetscErrorCode set_scales(TS ts) {
  GeneralizedAlpha* data = generalized_alpha_data(ts);

  PetscFunctionBegin;
  PetscCall(weigh(data));
  const Entries dynamic(data->dynamic), weight(data->weight), row(data->row);
  Changed scale(data->scale);
  const PetscReal of_row = PetscSqrtReal(data->shift_a);
  for (PetscInt i = 0, n = local_size(data->scale); i < n; ++i) {
    if (dynamic[i] == 0)
      scale[i] = of_row * row[i];
    else
      scale[i] = weight[i] > 0 ? 1 / PetscSqrtReal(weight[i]) : 1;
  }
  data->h_scale = data->h;
  renew_jacobian(ts->snes, 0);
  PetscFunctionReturn(0);
}

// Both scales of a Jacobian that was just formed. The solution of what SNES itself solves is scaled back by
// simplified-newton, which knows of it; other types of SNES do without.
PetscErrorCode scale_jacobian(TS ts, Mat P) {
  GeneralizedAlpha* data = generalized_alpha_data(ts);
  PetscBool dense, knows, compared;

  PetscFunctionBegin;
  PetscCall(PetscObjectTypeCompareAny((PetscObject)P, &dense, MATSEQDENSE, MATDENSE, ""));
  PetscCall(PetscObjectTypeCompare((PetscObject)ts->snes, simplified_newton, &knows));
  PetscCall(PetscOptionsHasName(((PetscObject)ts->snes)->options, ((PetscObject)ts->snes)->prefix,
                                "-snes_test_jacobian", &compared));  // with differences of F, which knows no columns
  data->two_sided = !dense && knows && !compared ? PETSC_TRUE : PETSC_FALSE;
  if (data->two_sided) PetscCall(VecCopy(data->scale, data->column));
  PetscCall(MatDiagonalScale(P, data->scale, data->two_sided ? data->column : nullptr));
  PetscCall(
      PetscObjectCompose((PetscObject)ts->snes, column_scales, data->two_sided ? (PetscObject)data->column : nullptr));
  PetscFunctionReturn(0);
}

// x with J x = b, b in scaled rows. The caller asks the KSP how it went.
PetscErrorCode solve_scaled(TS ts, Vec b, Vec x) {
  GeneralizedAlpha* data = generalized_alpha_data(ts);
  KSP ksp;
  Mat J, P;

  PetscFunctionBegin;
  PetscCall(SNESGetKSP(ts->snes, &ksp));
  PetscCall(SNESGetJacobian(ts->snes, &J, &P, nullptr, nullptr));
  PetscCall(KSPSetOperators(ksp, J, P));  // simplified-newton solves with small dense matrices without the KSP
  PetscCall(KSPSolve(ksp, b, x));
  if (data->two_sided) PetscCall(VecPointwiseMult(x, x, data->column));
  PetscFunctionReturn(0);
}

// y = J x, in scaled rows.
PetscErrorCode multiply_scaled(TS ts, Vec x, Vec y) {
  GeneralizedAlpha* data = generalized_alpha_data(ts);
  Mat P;

  PetscFunctionBegin;
  PetscCall(SNESGetJacobian(ts->snes, nullptr, &P, nullptr, nullptr));
  if (!data->two_sided) {
    PetscCall(MatMult(P, x, y));
    PetscFunctionReturn(0);
  }
  Vec unscaled;
  PetscCall(VecDuplicate(x, &unscaled));
  PetscCall(VecPointwiseDivide(unscaled, x, data->column));
  PetscCall(MatMult(P, unscaled, y));
  PetscCall(VecDestroy(&unscaled));
  PetscFunctionReturn(0);
}

// SNES forms a Jacobian when (iteration + jac_iter) is a multiple of the lag; -1 means never again, -2 once more.
void renew_jacobian(SNES snes, PetscInt iteration) {
  snes->jac_iter = snes->pre_iter = -iteration;
  if (snes->lagjacobian == -1) snes->lagjacobian = -2;
  if (snes->lagpreconditioner == -1) snes->lagpreconditioner = -2;
}

}  // namespace floe::solve
