#include "simplified_newton.h"

#include <petsc/private/snesimpl.h>

#include <string>

#include "dense_factor.h"
#include "floe/petsc/error.h"
#include "floe/petsc/options.h"

namespace floe::solve {
namespace {

struct Data {
  PetscBool quiet = PETSC_FALSE;       // no option asks for a view or a test in each solve
  PetscBool applies_pc = PETSC_FALSE;  // the KSP does nothing but apply its PC
  PetscBool dense = PETSC_FALSE;       // which is the LU factorisation of a small dense matrix
  DenseFactor factor;
  Rotate rotate = nullptr;
  void* rotation_context = nullptr;
  Vec rotated = nullptr;
};

Data* data_of(SNES snes) { return static_cast<Data*>(snes->data); }

// Whether DenseFactor does the same as KSP, PC and Mat: no option of the factor is given. Above some hundred unknowns
// the calls around do not matter.
PetscErrorCode find_dense(SNES snes, PetscBool* dense) {
  constexpr PetscInt most = 400;
  PetscBool only = PETSC_FALSE, lu = PETSC_FALSE, sequential = PETSC_FALSE, own = PETSC_TRUE;
  PetscInt n;
  PC pc;
  MatSolverType type = nullptr;

  PetscFunctionBegin;
  PetscCall(PetscObjectTypeCompare((PetscObject)snes->ksp, KSPPREONLY, &only));
  PetscCall(KSPGetPC(snes->ksp, &pc));
  PetscCall(PetscObjectTypeCompare((PetscObject)pc, PCLU, &lu));
  PetscCall(PetscObjectTypeCompare((PetscObject)snes->jacobian_pre, MATSEQDENSE, &sequential));
  PetscCall(MatGetSize(snes->jacobian_pre, &n, nullptr));
  if (lu) PetscCall(PCFactorGetMatSolverType(pc, &type));
  if (type) PetscCall(PetscStrcmp(type, MATSOLVERPETSC, &own));
  const char* prefix = ((PetscObject)snes)->prefix;
  const bool plain = !petsc::user_sets(std::string(prefix ? prefix : "") + "pc_factor_");
  *dense = only && lu && sequential && own && plain && n <= most ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}

PetscErrorCode set_up(SNES snes) {
  PetscBool only = PETSC_FALSE;

  PetscFunctionBegin;
  PetscCall(SNESSetUpMatrices(snes));
  PetscCall(PetscObjectTypeCompare((PetscObject)snes->ksp, KSPPREONLY, &only));
  data_of(snes)->applies_pc = only;
  PetscCall(find_dense(snes, &data_of(snes)->dense));
  PetscFunctionReturn(0);
}

// What SNESSolve and SNESComputeJacobian look up each time.
PetscErrorCode set_from_options(SNES snes, PetscOptionItems*) {
  PetscFunctionBegin;
  data_of(snes)->quiet = PETSC_TRUE;
  for (const char* name :
       {"-snes_converged_reason", "-snes_view", "-snes_view_solution", "-snes_view_pre", "-snes_test_local_min",
        "-snes_grid_sequence", "-snes_test_jacobian", "-snes_compare_explicit", "-snes_compare_explicit_draw",
        "-snes_compare_explicit_contour", "-snes_compare_coloring", "-snes_compare_operator"}) {
    PetscBool set = PETSC_FALSE;
    PetscCall(PetscOptionsHasName(((PetscObject)snes)->options, ((PetscObject)snes)->prefix, name, &set));
    if (set) data_of(snes)->quiet = PETSC_FALSE;
  }
  PetscFunctionReturn(0);
}

// J at U when its lag has passed; SNESComputeJacobian looks up a dozen options, which for a small system costs as much
// as J itself.
PetscErrorCode renew(SNES snes) {
  PetscErrorCode (*jacobian)(SNES, Vec, Mat, Mat, void*) = nullptr;
  void* context = nullptr;

  PetscFunctionBegin;
  if (!data_of(snes)->quiet || snes->lagjacobian < 1 || snes->lagpreconditioner != 1) {
    PetscCall(SNESComputeJacobian(snes, snes->vec_sol, snes->jacobian, snes->jacobian_pre));
    PetscFunctionReturn(0);
  }
  if ((snes->iter + snes->jac_iter) % snes->lagjacobian != 0) PetscFunctionReturn(0);
  PetscCall(PetscLogEventBegin(SNES_JacobianEval, snes, snes->vec_sol, snes->jacobian, snes->jacobian_pre));
  PetscCall(DMSNESGetJacobian(snes->dm, &jacobian, &context));
  PetscCall((*jacobian)(snes, snes->vec_sol, snes->jacobian, snes->jacobian_pre, context));
  PetscCall(KSPSetReusePreconditioner(snes->ksp, PETSC_FALSE));
  PetscCall(PetscLogEventEnd(SNES_JacobianEval, snes, snes->vec_sol, snes->jacobian, snes->jacobian_pre));
  PetscFunctionReturn(0);
}

PetscErrorCode rotate_back(SNES snes, Vec* F) {
  Data* data = data_of(snes);

  PetscFunctionBegin;
  if (!data->rotated) PetscCall(VecDuplicate(*F, &data->rotated));
  PetscCall(VecCopy(*F, data->rotated));
  PetscCall((*data->rotate)(snes, snes->vec_sol, PETSC_TRUE, data->rotated, data->rotation_context));
  *F = data->rotated;
  PetscFunctionReturn(0);
}

// Y = J^-1 F with the kept factorisation; *failed instead of an error, as KSPSolve has it.
PetscErrorCode solve_linear(SNES snes, Vec F, Vec Y, PetscBool* failed) {
  KSPConvergedReason reason;
  PetscInt iterations = 1;
  Vec columns = nullptr;

  PetscFunctionBegin;
  *failed = PETSC_FALSE;
  if (data_of(snes)->rotate) PetscCall(rotate_back(snes, &F));
  PetscBool factored = PETSC_FALSE;
  if (data_of(snes)->dense && snes->lagpreconditioner == 1)
    PetscCall(data_of(snes)->factor.factor(snes->jacobian_pre, &factored));
  if (!factored) PetscCall(KSPSetOperators(snes->ksp, snes->jacobian, snes->jacobian_pre));
  if (factored) {
    PetscCall(data_of(snes)->factor.solve(F, Y));
  } else if (data_of(snes)->applies_pc) {
    PC pc;
    PCFailedReason why;
    PetscCall(KSPSetUp(snes->ksp));
    PetscCall(KSPGetPC(snes->ksp, &pc));
    PetscCall(PCApply(pc, F, Y));
    PetscCall(PCGetFailedReason(pc, &why));
    *failed = why ? PETSC_TRUE : PETSC_FALSE;
  } else {
    PetscCall(KSPSolve(snes->ksp, F, Y));
    PetscCall(KSPGetConvergedReason(snes->ksp, &reason));
    PetscCall(KSPGetIterationNumber(snes->ksp, &iterations));
    *failed = reason < 0 ? PETSC_TRUE : PETSC_FALSE;
  }
  PetscCall(PetscObjectQuery((PetscObject)snes, column_scales, (PetscObject*)&columns));
  if (columns) PetscCall(VecPointwiseMult(Y, Y, columns));
  if (data_of(snes)->rotate)
    PetscCall((*data_of(snes)->rotate)(snes, snes->vec_sol, PETSC_FALSE, Y, data_of(snes)->rotation_context));
  snes->linear_its += iterations;
  PetscFunctionReturn(0);
}

// F(U) and its norm; a norm that is none ends the solve.
PetscErrorCode evaluate(SNES snes) {
  PetscReal norm;

  PetscFunctionBegin;
  PetscCall(SNESComputeFunction(snes, snes->vec_sol, snes->vec_func));
  PetscCall(VecNorm(snes->vec_func, NORM_2, &norm));
  SNESCheckFunctionNorm(snes, norm);
  snes->norm = norm;
  PetscCall(SNESLogConvergenceHistory(snes, norm, snes->iter));
  PetscCall(SNESMonitor(snes, snes->iter, norm));
  PetscFunctionReturn(0);
}

PetscErrorCode solve(SNES snes) {
  PetscBool failed;

  PetscFunctionBegin;
  snes->reason = SNES_CONVERGED_ITERATING;
  snes->iter = 0;
  PetscCall(evaluate(snes));
  if (!snes->reason) PetscUseTypeMethod(snes, converged, 0, 0.0, 0.0, snes->norm, &snes->reason, snes->cnvP);
  while (!snes->reason) {
    if (snes->iter == snes->max_its) {
      snes->reason = SNES_DIVERGED_MAX_IT;
      break;
    }
    PetscCall(renew(snes));
    SNESCheckJacobianDomainerror(snes);
    PetscCall(solve_linear(snes, snes->vec_func, snes->vec_sol_update, &failed));
    if (failed) {
      snes->numLinearSolveFailures++;
      snes->reason = SNES_DIVERGED_LINEAR_SOLVE;
      break;
    }
    PetscCall(VecAXPY(snes->vec_sol, -1, snes->vec_sol_update));
    snes->iter++;
    PetscUseTypeMethod(snes, converged, snes->iter, 0.0, 0.0, snes->norm, &snes->reason, snes->cnvP);
    if (!snes->reason) PetscCall(evaluate(snes));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode reset(SNES snes) {
  PetscFunctionBegin;
  PetscCall(VecDestroy(&data_of(snes)->rotated));
  PetscFunctionReturn(0);
}

PetscErrorCode destroy(SNES snes) {
  PetscFunctionBegin;
  PetscCall(reset(snes));
  delete data_of(snes);
  snes->data = nullptr;
  PetscFunctionReturn(0);
}

PetscErrorCode create(SNES snes) {
  PetscFunctionBegin;
  snes->data = new Data;
  snes->ops->setup = set_up;
  snes->ops->solve = solve;
  snes->ops->setfromoptions = set_from_options;
  snes->ops->reset = reset;
  snes->ops->destroy = destroy;
  snes->usesksp = PETSC_TRUE;
  snes->usesnpc = PETSC_FALSE;
  snes->alwayscomputesfinalresidual = PETSC_FALSE;
  PetscFunctionReturn(0);
}

}  // namespace

void register_simplified_newton() { petsc::check(SNESRegister(simplified_newton, create)); }

PetscErrorCode set_rotation(SNES snes, Rotate rotate, void* context) {
  PetscFunctionBegin;
  if (snes->ops->solve != solve) PetscFunctionReturn(0);
  data_of(snes)->rotate = rotate;
  data_of(snes)->rotation_context = context;
  PetscFunctionReturn(0);
}

PetscErrorCode solve_again(SNES snes, Vec U) {
  PetscFunctionBegin;
  if (snes->ops->solve != solve || !snes->setupcalled || !snes->vec_sol_update || snes->vec_sol != U ||
      !data_of(snes)->quiet) {
    PetscCall(SNESSolve(snes, nullptr, U));
    PetscFunctionReturn(0);
  }
  if (snes->counters_reset) snes->nfuncs = snes->linear_its = snes->numFailures = 0;
  PetscCall(PetscLogEventBegin(SNES_Solve, snes, 0, 0, 0));
  PetscCall(solve(snes));
  PetscCall(PetscLogEventEnd(SNES_Solve, snes, 0, 0, 0));
  if (snes->lagjac_persist) snes->jac_iter += snes->iter;
  if (snes->lagpre_persist) snes->pre_iter += snes->iter;
  PetscFunctionReturn(0);
}

}  // namespace floe::solve
