#include "generalized_alpha_data.h"

// Rotations A = base exp(x) with angular velocities w in rotated axes: A' = A ~w and T(x) x' = w, T(x) = I - ~x/2 + ...
// . With x = 0 at the beginning of a step the plain sums of the scheme are those of the Lie algebra, and order 2 stays.
// Where the scheme is corrected to order 3, x is not the integral of w:
//   x(h) = h w + h^2/2 w' + h^3/6 w'' + h^3/12 [w, w'] + ...,   x' = w + [x, w]/2 + ...,   [a, b] = a x b
// This counts in the velocities of a first step (generalized_alpha_start.cpp), in the error of a step and in what is
// interpolated. Source: Arnold, Cardona, Bruels 2015, Order reduction in time integration caused by velocity
// projection.

namespace floe::solve {

PetscErrorCode rebase(TS ts) {
  GeneralizedAlpha* data = generalized_alpha_data(ts);

  PetscFunctionBegin;
  if (!data->rotations.rebase) PetscFunctionReturn(0);
  PetscCall(VecCopy(ts->vec_sol, data->work_U));
  PetscCall((*data->rotations.rebase)(ts, ts->vec_sol, data->rotations.context));
  PetscCall(VecAYPX(data->work_U, -1, ts->vec_sol));
  PetscCall(VecAXPY(data->origin, 1, data->work_U));
  PetscFunctionReturn(0);
}

namespace {

PetscErrorCode mark_angles(GeneralizedAlpha* data) {
  const PetscInt* indices;
  PetscInt count, first;

  PetscFunctionBegin;
  PetscCall(VecCopy(data->attitude_rows, data->rotation_rows));
  if (!data->rotations.angles) PetscFunctionReturn(0);
  PetscCall(VecGetOwnershipRange(data->rotation_rows, &first, nullptr));
  PetscCall(ISGetLocalSize(data->rotations.angles, &count));
  PetscCall(ISGetIndices(data->rotations.angles, &indices));
  {
    Changed rows(data->rotation_rows);
    for (PetscInt i = 0; i < count; ++i) rows[indices[i] - first] = 1;
  }
  PetscCall(ISRestoreIndices(data->rotations.angles, &indices));
  PetscFunctionReturn(0);
}

}  // namespace

// A row is one of an attitude where the bracket of two vectors, no three entries of which are parallel, is not zero.
PetscErrorCode mark_attitudes(TS ts) {
  GeneralizedAlpha* data = generalized_alpha_data(ts);
  PetscInt first;

  PetscFunctionBegin;
  PetscCall(VecSet(data->attitude_rows, 0));
  PetscCall(mark_angles(data));
  if (!data->rotations.bracket) PetscFunctionReturn(0);
  PetscCall(VecGetOwnershipRange(data->attitude_rows, &first, nullptr));
  {
    Changed a(data->work_U), b(data->work_V);
    for (PetscInt i = 0, n = local_size(data->attitude_rows); i < n; ++i) {
      a[i] = PetscSinReal(1 + 1.3 * (PetscReal)(first + i));
      b[i] = PetscSinReal(2 + 1.9 * (PetscReal)(first + i));
    }
  }
  PetscCall((*data->rotations.bracket)(ts, data->work_U, data->work_V, data->attitude_rows, data->rotations.context));
  {
    Changed attitude_rows(data->attitude_rows);
    for (PetscInt i = 0, n = local_size(data->attitude_rows); i < n; ++i)
      attitude_rows[i] = attitude_rows[i] != 0 ? 1 : 0;
  }
  PetscCall(mark_angles(data));
  PetscCall(VecSet(data->work_U, 0));
  PetscCall(VecSet(data->work_V, 0));
  PetscFunctionReturn(0);
}

namespace {

void scale_rows(GeneralizedAlpha* data, Vec y_vec, bool into) {
  const Entries scale(data->scale);
  Changed y(y_vec);
  for (PetscInt i = 0, n = local_size(y_vec); i < n; ++i) y[i] *= into ? scale[i] : 1 / scale[i];
}

}  // namespace

// A Jacobian just formed is one of U.
PetscErrorCode rotation_kept(SNES, Vec U, PetscBool back, Vec y, void* context) {
  TS ts = static_cast<TS>(context);
  GeneralizedAlpha* data = generalized_alpha_data(ts);

  PetscFunctionBegin;
  if (data->new_jacobian) PetscFunctionReturn(0);
  if (back) scale_rows(data, y, false);
  PetscCall((*data->rotations.rotate)(ts, U, back, y, data->rotations.context));
  if (back) scale_rows(data, y, true);
  PetscFunctionReturn(0);
}

PetscErrorCode add_bracket(TS ts, PetscReal factor, Vec a, Vec b, Vec W, Vec y) {
  GeneralizedAlpha* data = generalized_alpha_data(ts);

  PetscFunctionBegin;
  if (!data->rotations.bracket) PetscFunctionReturn(0);
  PetscCall((*data->rotations.bracket)(ts, a, b, W, data->rotations.context));
  PetscCall(VecAXPY(y, factor, W));
  PetscFunctionReturn(0);
}

}  // namespace floe::solve
