#include "floe/solve/generalized_alpha.h"

#include "floe/petsc/error.h"
#include "generalized_alpha_data.h"
#include "simplified_newton.h"

// The scheme of Arnold and Bruels (2007) for F(t, U, V, A) = 0, U = (q, lambda), everything at the end of the step:
//   F(t_1, U_1, V_1, A_1) = 0
//   (1 - am) a_1 + am a_0 = (1 - af) A_1 + af A_0
//   q_1 = q_0 + h v_0 + h^2 ((1/2 - b) a_0 + b a_1),   v_1 = v_0 + h ((1 - g) a_0 + g a_1)
//   am = (2 rho - 1)/(rho + 1),  af = rho/(rho + 1),  g = 1/2 + af - am,  b = (g + 1/2)^2/4
// A is the acceleration that satisfies the equations of motion, a the auxiliary one: a_n = A(t_n + (am - af) h) +
// O(h^2). Multipliers have no rates; rows whose unknown is a multiplier hold constraints C(q, t) = 0. At rho = 1 the
// multipliers oscillate undamped: refused. Rotations: generalized_alpha_rotations.cpp.

namespace floe::solve {
namespace {

using Data = GeneralizedAlpha;

constexpr Vec Data::*vectors[] = {&Data::U0,        &Data::V0,
                                  &Data::A0,        &Data::a0,
                                  &Data::U1,        &Data::V1,
                                  &Data::A1,        &Data::a1,
                                  &Data::jerk,      &Data::normal,
                                  &Data::a_used,    &Data::base_q,
                                  &Data::base_v,    &Data::base_A,
                                  &Data::dynamic,   &Data::stiffness,
                                  &Data::mass,      &Data::row,
                                  &Data::scale,     &Data::weight,
                                  &Data::origin,    &Data::attitude_rows,
                                  &Data::tangent_U, &Data::tangent_V,
                                  &Data::tangent_A, &Data::work_U,
                                  &Data::work_V,    &Data::work_A,
                                  &Data::work_F,    &Data::column,
                                  &Data::A_before,  &Data::rotation_rows,
                                  &Data::middle_U,  &Data::middle_V,
                                  &Data::middle_A};

PetscErrorCode mark_dynamic_rows(Data* data) {
  PetscFunctionBegin;
  PetscCall(VecSet(data->dynamic, 1));
  if (data->multipliers) {
    PetscInt first, last, count;
    const PetscInt* indices;
    PetscCall(VecGetOwnershipRange(data->dynamic, &first, &last));
    PetscCall(ISGetLocalSize(data->multipliers, &count));
    PetscCall(ISGetIndices(data->multipliers, &indices));
    Changed dynamic(data->dynamic);
    for (PetscInt i = 0; i < count; ++i) {
      PetscCheck(indices[i] >= first && indices[i] < last, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
                 "Multiplier %" PetscInt_FMT " is not owned by this rank", indices[i]);
      dynamic[indices[i] - first] = 0;
    }
    PetscCall(ISRestoreIndices(data->multipliers, &indices));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode set_up(TS ts) {
  Data* data = generalized_alpha_data(ts);
  TSI2Function function;
  TSI2Jacobian jacobian;
  PetscBool fixed;
  DM dm;

  PetscFunctionBegin;
  PetscCall(TSGetDM(ts, &dm));
  PetscCall(DMTSGetI2Function(dm, &function, nullptr));
  PetscCall(DMTSGetI2Jacobian(dm, &jacobian, nullptr));
  PetscCheck(function && jacobian, PetscObjectComm((PetscObject)ts), PETSC_ERR_ARG_WRONGSTATE,
             "%s needs TSSetI2Function and TSSetI2Jacobian", generalized_alpha);
  PetscCheck(ts->vec_dot, PetscObjectComm((PetscObject)ts), PETSC_ERR_ARG_WRONGSTATE, "%s needs TS2SetSolution",
             generalized_alpha);
  for (auto vector : vectors) {
    PetscCall(VecDuplicate(ts->vec_sol, &(data->*vector)));
    PetscCall(VecSet(data->*vector, 0));
  }
  PetscCall(mark_dynamic_rows(data));
  PetscCall(mark_attitudes(ts));
  PetscCall(set_rotation(ts->snes, data->rotations.rotate ? rotation_kept : nullptr, ts));
  // With a fixed step TS ends at the first failed Newton solve; with an adaptive one it cuts the step, max_reject
  // times.
  PetscCall(TSGetAdapt(ts, &ts->adapt));
  PetscCall(PetscObjectTypeCompare((PetscObject)ts->adapt, TSADAPTNONE, &fixed));
  if (!fixed && ts->max_snes_failures == 1) ts->max_snes_failures = -1;
  PetscFunctionReturn(0);
}

PetscErrorCode reset(TS ts) {
  Data* data = generalized_alpha_data(ts);

  PetscFunctionBegin;
  for (auto vector : vectors) PetscCall(VecDestroy(&(data->*vector)));
  data->started = PETSC_FALSE;
  data->h_scale = 0;
  PetscFunctionReturn(0);
}

PetscErrorCode set_multipliers(TS ts, IS multipliers) {
  Data* data = generalized_alpha_data(ts);

  PetscFunctionBegin;
  if (multipliers) PetscCall(PetscObjectReference((PetscObject)multipliers));
  PetscCall(ISDestroy(&data->multipliers));
  data->multipliers = multipliers;
  if (data->dynamic) PetscCall(mark_dynamic_rows(data));
  PetscFunctionReturn(0);
}

PetscErrorCode set_radius(TS ts, PetscReal rho) {
  Data* data = generalized_alpha_data(ts);

  PetscFunctionBegin;
  PetscCheck(rho >= 0 && rho < 1, PetscObjectComm((PetscObject)ts), PETSC_ERR_ARG_OUTOFRANGE,
             "The spectral radius of %s must be in [0, 1), not %g: at 1 the multipliers oscillate undamped",
             generalized_alpha, (double)rho);
  data->rho = rho;
  data->alpha_m = (2 * rho - 1) / (rho + 1);
  data->alpha_f = rho / (rho + 1);
  data->gamma = 0.5 + data->alpha_f - data->alpha_m;
  data->beta = PetscSqr(data->gamma + 0.5) / 4;
  PetscFunctionReturn(0);
}

PetscErrorCode set_start(TS ts, TSGeneralizedAlphaStart start, void* context) {
  Data* data = generalized_alpha_data(ts);

  PetscFunctionBegin;
  data->start = start;
  data->start_context = context;
  PetscFunctionReturn(0);
}

PetscErrorCode set_rotations(TS ts, const TSGeneralizedAlphaRotations* rotations) {
  PetscFunctionBegin;
  PetscCheck(!rotations->rebase == !rotations->bracket, PetscObjectComm((PetscObject)ts), PETSC_ERR_ARG_WRONG,
             "Rotations need rebase and bracket, or neither");
  if (rotations->angles) PetscCall(PetscObjectReference((PetscObject)rotations->angles));
  PetscCall(ISDestroy(&generalized_alpha_data(ts)->rotations.angles));
  generalized_alpha_data(ts)->rotations = *rotations;
  PetscFunctionReturn(0);
}

PetscErrorCode get_acceleration(TS ts, Vec* A) {
  Data* data = generalized_alpha_data(ts);

  PetscFunctionBegin;
  *A = data->started ? data->A1 : nullptr;
  PetscFunctionReturn(0);
}

PetscErrorCode get_event_error(TS ts, PetscReal* error) {
  PetscFunctionBegin;
  *error = generalized_alpha_data(ts)->event_error;
  PetscFunctionReturn(0);
}

PetscErrorCode set_forces_jump(TS ts) {
  PetscFunctionBegin;
  generalized_alpha_data(ts)->forces_jump = PETSC_TRUE;
  PetscFunctionReturn(0);
}

PetscErrorCode set_state_loads(TS ts) {
  PetscFunctionBegin;
  generalized_alpha_data(ts)->state_loads = PETSC_TRUE;
  PetscFunctionReturn(0);
}

PetscErrorCode set_from_options(TS ts, PetscOptionItems* PetscOptionsObject) {
  PetscReal rho = generalized_alpha_data(ts)->rho;
  PetscBool set;

  PetscFunctionBegin;
  PetscOptionsHeadBegin(PetscOptionsObject, "Generalized-alpha (Arnold and Bruels) options");
  PetscCall(PetscOptionsReal("-ts_generalized_alpha_radius", "Spectral radius at infinite frequency, 0 <= rho < 1",
                             "TSGeneralizedAlphaSetRadius", rho, &rho, &set));
  if (set) PetscCall(set_radius(ts, rho));
  PetscOptionsHeadEnd();
  PetscFunctionReturn(0);
}

PetscErrorCode view(TS ts, PetscViewer viewer) {
  Data* data = generalized_alpha_data(ts);
  PetscBool ascii;

  PetscFunctionBegin;
  PetscCall(PetscObjectTypeCompare((PetscObject)viewer, PETSCVIEWERASCII, &ascii));
  if (ascii) {
    PetscCall(PetscViewerASCIIPrintf(viewer, "  spectral radius %g: alpha_m=%g, alpha_f=%g, gamma=%g, beta=%g\n",
                                     (double)data->rho, (double)data->alpha_m, (double)data->alpha_f,
                                     (double)data->gamma, (double)data->beta));
  }
  PetscFunctionReturn(0);
}

constexpr const char* set_multipliers_name = "TSGeneralizedAlphaSetMultipliers_C";
constexpr const char* set_radius_name = "TSGeneralizedAlphaSetRadius_C";
constexpr const char* set_start_name = "TSGeneralizedAlphaSetStart_C";
constexpr const char* set_rotations_name = "TSGeneralizedAlphaSetRotations_C";
constexpr const char* set_forces_jump_name = "TSGeneralizedAlphaSetForcesJump_C";
constexpr const char* set_state_loads_name = "TSGeneralizedAlphaSetStateLoads_C";
constexpr const char* interpolate_name = "TSGeneralizedAlphaInterpolate_C";
constexpr const char* get_acceleration_name = "TSGeneralizedAlphaGetAcceleration_C";
constexpr const char* get_event_error_name = "TSGeneralizedAlphaGetEventError_C";

PetscErrorCode destroy(TS ts) {
  PetscFunctionBegin;
  PetscCall(reset(ts));
  PetscCall(ISDestroy(&generalized_alpha_data(ts)->multipliers));
  PetscCall(ISDestroy(&generalized_alpha_data(ts)->rotations.angles));
  if (ts->snes) PetscCall(SNESSetConvergenceTest(ts->snes, SNESConvergedDefault, nullptr, nullptr));
  delete generalized_alpha_data(ts);
  ts->data = nullptr;
  for (const char* name :
       {set_multipliers_name, set_radius_name, set_start_name, set_forces_jump_name, set_rotations_name,
        set_state_loads_name, get_acceleration_name, get_event_error_name, interpolate_name})
    PetscCall(PetscObjectComposeFunction((PetscObject)ts, name, nullptr));
  PetscFunctionReturn(0);
}

// Newton takes full steps (near round-off a residual-reducing line search would refuse good ones) with a direct solver;
// the line search is for -snes_type newtonls.
PetscErrorCode set_solver_defaults(TS ts) {
  SNES snes;
  SNESLineSearch line_search;
  KSP ksp;
  PC pc;

  PetscFunctionBegin;
  PetscCall(TSGetSNES(ts, &snes));
  PetscCall(SNESSetType(snes, simplified_newton));
  PetscCall(SNESSetConvergenceTest(snes, newton_converged, ts, nullptr));
  PetscCall(SNESSetTolerances(snes, PETSC_DEFAULT, 1e-10, PETSC_DEFAULT, 20, PETSC_DEFAULT));
  PetscCall(SNESGetLineSearch(snes, &line_search));
  PetscCall(SNESLineSearchSetType(line_search, SNESLINESEARCHBASIC));
  PetscCall(SNESGetKSP(snes, &ksp));
  PetscCall(KSPSetType(ksp, KSPPREONLY));
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PCSetType(pc, PCLU));
  PetscFunctionReturn(0);
}

PetscErrorCode create(TS ts) {
  PetscFunctionBegin;
  ts->data = new Data;
  ts->ops->setup = set_up;
  ts->ops->step = step;
  ts->ops->rollback = roll_back;
  ts->ops->interpolate = interpolate;
  ts->ops->evaluatewlte = local_error;
  ts->ops->setfromoptions = set_from_options;
  ts->ops->view = view;
  ts->ops->reset = reset;
  ts->ops->destroy = destroy;
  ts->ops->snesfunction = form_function;
  ts->ops->snesjacobian = form_jacobian;
  ts->usessnes = PETSC_TRUE;
  ts->default_adapt_type = TSADAPTNONE;
  PetscCall(set_radius(ts, 0.8));
  // A stiff motion that starts out of balance needs steps of its fastest decay, some decades below the one asked for,
  // each cut to a half or less (an error relative to how far it has moved).
  PetscCall(TSSetMaxStepRejections(ts, 40));
  PetscCall(set_solver_defaults(ts));
  PetscCall(PetscObjectComposeFunction((PetscObject)ts, set_multipliers_name, set_multipliers));
  PetscCall(PetscObjectComposeFunction((PetscObject)ts, set_radius_name, set_radius));
  PetscCall(PetscObjectComposeFunction((PetscObject)ts, set_start_name, set_start));
  PetscCall(PetscObjectComposeFunction((PetscObject)ts, set_forces_jump_name, set_forces_jump));
  PetscCall(PetscObjectComposeFunction((PetscObject)ts, set_state_loads_name, set_state_loads));
  PetscCall(PetscObjectComposeFunction((PetscObject)ts, set_rotations_name, set_rotations));
  PetscCall(PetscObjectComposeFunction((PetscObject)ts, get_acceleration_name, get_acceleration));
  PetscCall(PetscObjectComposeFunction((PetscObject)ts, get_event_error_name, get_event_error));
  PetscCall(PetscObjectComposeFunction((PetscObject)ts, interpolate_name, interpolate_all));
  PetscFunctionReturn(0);
}

}  // namespace

void register_generalized_alpha() {
  petsc::check(TSRegister(generalized_alpha, create));
  register_simplified_newton();
}

PetscErrorCode TSGeneralizedAlphaSetMultipliers(TS ts, IS multipliers) {
  PetscFunctionBegin;
  PetscTryMethod(ts, "TSGeneralizedAlphaSetMultipliers_C", (TS, IS), (ts, multipliers));
  PetscFunctionReturn(0);
}

PetscErrorCode TSGeneralizedAlphaSetRadius(TS ts, PetscReal rho) {
  PetscFunctionBegin;
  PetscTryMethod(ts, "TSGeneralizedAlphaSetRadius_C", (TS, PetscReal), (ts, rho));
  PetscFunctionReturn(0);
}

PetscErrorCode TSGeneralizedAlphaSetStart(TS ts, TSGeneralizedAlphaStart start, void* context) {
  PetscFunctionBegin;
  PetscTryMethod(ts, "TSGeneralizedAlphaSetStart_C", (TS, TSGeneralizedAlphaStart, void*), (ts, start, context));
  PetscFunctionReturn(0);
}

PetscErrorCode TSGeneralizedAlphaSetForcesJump(TS ts) {
  PetscFunctionBegin;
  PetscTryMethod(ts, "TSGeneralizedAlphaSetForcesJump_C", (TS), (ts));
  PetscFunctionReturn(0);
}

PetscErrorCode TSGeneralizedAlphaSetStateLoads(TS ts) {
  PetscFunctionBegin;
  PetscTryMethod(ts, "TSGeneralizedAlphaSetStateLoads_C", (TS), (ts));
  PetscFunctionReturn(0);
}

PetscErrorCode TSGeneralizedAlphaSetRotations(TS ts, const TSGeneralizedAlphaRotations* rotations) {
  PetscFunctionBegin;
  PetscTryMethod(ts, "TSGeneralizedAlphaSetRotations_C", (TS, const TSGeneralizedAlphaRotations*), (ts, rotations));
  PetscFunctionReturn(0);
}

PetscErrorCode TSGeneralizedAlphaInterpolate(TS ts, PetscReal t, Vec U, Vec V, Vec A) {
  PetscFunctionBegin;
  PetscUseMethod(ts, "TSGeneralizedAlphaInterpolate_C", (TS, PetscReal, Vec, Vec, Vec), (ts, t, U, V, A));
  PetscFunctionReturn(0);
}

PetscErrorCode TSGeneralizedAlphaGetAcceleration(TS ts, Vec* A) {
  PetscFunctionBegin;
  *A = nullptr;
  PetscTryMethod(ts, "TSGeneralizedAlphaGetAcceleration_C", (TS, Vec*), (ts, A));
  PetscFunctionReturn(0);
}

PetscErrorCode TSGeneralizedAlphaGetEventError(TS ts, PetscReal* error) {
  PetscFunctionBegin;
  *error = 0;
  PetscTryMethod(ts, "TSGeneralizedAlphaGetEventError_C", (TS, PetscReal*), (ts, error));
  PetscFunctionReturn(0);
}

}  // namespace floe::solve
