#include "../../../src/solve/simplified_newton.h"

#include <petscsnes.h>

#include <catch2/catch.hpp>

#include "floe/petsc/handle.h"

using namespace floe;
using petsc::check;

namespace {

/// x_i^2 = i + 1, counting evaluations.
struct Roots {
  int functions = 0, jacobians = 0;
};

PetscErrorCode residual(SNES, Vec U, Vec F, void* context) {
  const double* u;
  double* f;
  ++static_cast<Roots*>(context)->functions;
  VecGetArrayRead(U, &u), VecGetArray(F, &f);
  for (int i = 0; i < 3; ++i) f[i] = u[i] * u[i] - (i + 1);
  VecRestoreArrayRead(U, &u), VecRestoreArray(F, &f);
  return 0;
}

PetscErrorCode tangent(SNES, Vec U, Mat, Mat J, void* context) {
  const double* u;
  ++static_cast<Roots*>(context)->jacobians;
  VecGetArrayRead(U, &u);
  for (PetscInt i = 0; i < 3; ++i) MatSetValue(J, i, i, 2 * u[i], INSERT_VALUES);
  VecRestoreArrayRead(U, &u);
  MatAssemblyBegin(J, MAT_FINAL_ASSEMBLY), MatAssemblyEnd(J, MAT_FINAL_ASSEMBLY);
  return 0;
}

/// By the update, as the convergence test of generalized-alpha.
PetscErrorCode small_update(SNES snes, PetscInt iteration, PetscReal, PetscReal, PetscReal, SNESConvergedReason* reason,
                            void*) {
  Vec update;
  PetscReal size;
  *reason = SNES_CONVERGED_ITERATING;
  if (iteration == 0) return 0;
  SNESGetSolutionUpdate(snes, &update);
  VecNorm(update, NORM_2, &size);
  if (size < 1e-9) *reason = SNES_CONVERGED_SNORM_RELATIVE;
  return 0;
}

struct Solver {
  Roots count;
  petsc::VecHandle U, F;
  petsc::MatHandle J;
  SNES snes = nullptr;

  explicit Solver(SNESType type, int lag) {
    check(VecCreateSeq(PETSC_COMM_SELF, 3, U.out()));
    check(VecDuplicate(U, F.out()));
    check(MatCreateSeqDense(PETSC_COMM_SELF, 3, 3, nullptr, J.out()));
    check(SNESCreate(PETSC_COMM_SELF, &snes));
    check(SNESSetOptionsPrefix(snes, "roots_"));
    check(SNESSetFunction(snes, F, residual, &count));
    check(SNESSetJacobian(snes, J, J, tangent, &count));
    check(SNESSetType(snes, type));
    SNESLineSearch search = nullptr;
    check(SNESGetLineSearch(snes, &search));
    check(SNESLineSearchSetType(search, SNESLINESEARCHBASIC));
    KSP ksp = nullptr;
    PC pc = nullptr;
    check(SNESGetKSP(snes, &ksp));
    check(KSPSetType(ksp, KSPPREONLY));
    check(KSPGetPC(ksp, &pc));
    check(PCSetType(pc, PCLU));
    check(SNESSetConvergenceTest(snes, small_update, nullptr, nullptr));
    check(SNESSetLagJacobian(snes, lag));
    check(SNESSetLagJacobianPersists(snes, PETSC_TRUE));
    check(SNESSetFromOptions(snes));
  }
  ~Solver() { SNESDestroy(&snes); }

  double worst() const {
    const double* u;
    double error = 0;
    VecGetArrayRead(U, &u);
    for (int i = 0; i < 3; ++i) error = std::max(error, std::abs(u[i] - std::sqrt(i + 1.0)));
    VecRestoreArrayRead(U, &u);
    return error;
  }
};

}  // namespace

TEST_CASE("simplified Newton takes the iterations of newtonls with one residual less") {
  solve::register_simplified_newton();
  for (int lag : {1, 3}) {
    Solver ours(solve::simplified_newton, lag), stock(SNESNEWTONLS, lag);
    for (int again = 0; again < 3; ++again) {
      for (Solver* solver : {&ours, &stock}) {
        check(VecSet(solver->U, 1.5));
        check(solve::solve_again(solver->snes, solver->U));
        CHECK(solver->worst() < 1e-12);
      }
      PetscInt mine = 0, theirs = 0, linear = 0;
      check(SNESGetIterationNumber(ours.snes, &mine));
      check(SNESGetIterationNumber(stock.snes, &theirs));
      check(SNESGetLinearSolveIterations(ours.snes, &linear));
      CHECK(mine == theirs);
      CHECK(linear == mine);
      CHECK(ours.count.functions == mine);
      CHECK(stock.count.functions == theirs + 1);
      CHECK(ours.count.jacobians == stock.count.jacobians);
      ours.count = stock.count = {};
    }
  }
}

TEST_CASE("simplified Newton says how it failed") {
  Solver solver(solve::simplified_newton, 1);
  SNESConvergedReason reason;
  check(SNESSetTolerances(solver.snes, PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT, 2, PETSC_DEFAULT));
  check(VecSet(solver.U, 1.5));
  check(solve::solve_again(solver.snes, solver.U));
  check(SNESGetConvergedReason(solver.snes, &reason));
  CHECK(reason == SNES_DIVERGED_MAX_IT);
  check(VecSet(solver.U, std::nan("")));
  check(solve::solve_again(solver.snes, solver.U));
  check(SNESGetConvergedReason(solver.snes, &reason));
  CHECK(reason == SNES_DIVERGED_FNORM_NAN);
}

namespace {

/// Makes J at U of J = 2 diag(x) kept from x = 1.5: half of the ratio before the solve and half after it.
PetscErrorCode to_present(SNES, Vec U, PetscBool, Vec y, void*) {
  const double* u;
  double* entries;
  VecGetArrayRead(U, &u), VecGetArray(y, &entries);
  for (int i = 0; i < 3; ++i) entries[i] *= std::sqrt(1.5 / u[i]);
  VecRestoreArrayRead(U, &u), VecRestoreArray(y, &entries);
  return 0;
}

}  // namespace

TEST_CASE("simplified Newton with a kept Jacobian that is turned to U is Newton") {
  solve::register_simplified_newton();
  Solver newton(solve::simplified_newton, 1), kept(solve::simplified_newton, 100);
  check(solve::set_rotation(kept.snes, to_present, nullptr));
  PetscInt iterations[2] = {0, 0};
  for (Solver* solver : {&newton, &kept}) {
    check(VecSet(solver->U, 1.5));
    check(solve::solve_again(solver->snes, solver->U));
    CHECK(solver->worst() < 1e-12);
    check(SNESGetIterationNumber(solver->snes, &iterations[solver == &kept]));
  }
  CHECK(kept.count.jacobians == 1);
  CHECK(iterations[1] == iterations[0]);
}
