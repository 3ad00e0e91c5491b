#include <catch2/catch.hpp>

#include "generalized_alpha_problem.h"

using namespace floe::solve;
using namespace floe::solve::problems;

// The same system on one rank with a dense Jacobian and on all ranks with a sparse one (MUMPS). Runs on any number of
// ranks.

namespace {

constexpr int masses = 9;

// Masses 1, 2, ... on a chain of cubic springs, the first and the last moving in opposition: C = q_1 + 2 q_9.
Problem chain() {
  Problem p;
  p.size = masses + 1;
  p.multipliers = {masses};
  const auto gradient = [](int j) { return j == 0 ? 1. : j == masses - 1 ? 2. : 0.; };
  const auto force = [](const double* u, double* f) {
    for (int j = 0; j + 1 < masses; ++j) {
      const double x = u[j + 1] - u[j], s = x + x * x * x;
      f[j] -= s;
      f[j + 1] += s;
    }
  };
  p.residual = [=](double, const double* u, const double*, const double* a, double* f) {
    force(u, f);
    for (int j = 0; j < masses; ++j) f[j] += (1 + j) * a[j] + gradient(j) * u[masses];
    f[masses] = u[0] + 2 * u[masses - 1];
  };
  p.tangent = [=](double, const double* u, const double*, const double*, double, double sa, double* J) {
    const auto at = [J](int i, int j) -> double& { return J[i * (masses + 1) + j]; };
    for (int j = 0; j + 1 < masses; ++j) {
      const double x = u[j + 1] - u[j], k = 1 + 3 * x * x;
      at(j, j) += k, at(j + 1, j + 1) += k, at(j, j + 1) -= k, at(j + 1, j) -= k;
    }
    for (int j = 0; j < masses; ++j)
      at(j, j) += sa * (1 + j), at(j, masses) += gradient(j), at(masses, j) += gradient(j);
  };
  p.start = [=](double, double* u, const double*, double* a) {
    double f[masses] = {}, free = 0, mobility = 0;
    force(u, f);
    for (int j = 0; j < masses; ++j) {
      free += gradient(j) * -f[j] / (1 + j);
      mobility += gradient(j) * gradient(j) / (1 + j);
    }
    u[masses] = free / mobility;
    for (int j = 0; j < masses; ++j) a[j] = (-f[j] - gradient(j) * u[masses]) / (1 + j);
  };
  return p;
}

Numbers everywhere(Vec vec) {
  floe::petsc::VecHandle all;
  floe::petsc::ScatterHandle scatter;
  check(VecScatterCreateToAll(vec, scatter.out(), all.out()));
  check(VecScatterBegin(scatter, vec, all, INSERT_VALUES, SCATTER_FORWARD));
  check(VecScatterEnd(scatter, vec, all, INSERT_VALUES, SCATTER_FORWARD));
  return numbers(all);
}

void fill_owned(Vec vec, const Numbers& all) {
  PetscInt first, last;
  check(VecGetOwnershipRange(vec, &first, &last));
  fill(vec, Numbers(all.begin() + first, all.begin() + last));
}

PetscErrorCode shared_residual(TS, PetscReal t, Vec U, Vec V, Vec A, Vec F, void* context) {
  Numbers f(masses + 1, 0.0);
  static_cast<Problem*>(context)->residual(t, everywhere(U).data(), everywhere(V).data(), everywhere(A).data(),
                                           f.data());
  fill_owned(F, f);
  return 0;
}

PetscErrorCode shared_tangent(TS, PetscReal t, Vec U, Vec V, Vec A, PetscReal sv, PetscReal sa, Mat, Mat P,
                              void* context) {
  Numbers J((masses + 1) * (masses + 1), 0.0);
  static_cast<Problem*>(context)->tangent(t, everywhere(U).data(), everywhere(V).data(), everywhere(A).data(), sv, sa,
                                          J.data());
  PetscInt first, last;
  check(MatGetOwnershipRange(P, &first, &last));
  for (PetscInt i = first; i < last; ++i)
    for (PetscInt j = 0; j <= masses; ++j)
      check(MatSetValue(P, i, j, J[static_cast<size_t>(i * (masses + 1) + j)], INSERT_VALUES));
  check(MatAssemblyBegin(P, MAT_FINAL_ASSEMBLY));
  check(MatAssemblyEnd(P, MAT_FINAL_ASSEMBLY));
  return 0;
}

PetscErrorCode shared_start(TS, PetscReal t, Vec U, Vec V, Vec A, void* context) {
  Numbers u = everywhere(U), a(masses + 1, 0.0);
  static_cast<Problem*>(context)->start(t, u.data(), everywhere(V).data(), a.data());
  fill_owned(U, u);
  fill_owned(A, a);
  return 0;
}

PetscErrorCode no_record(TS) { return 0; }

void use_mumps(TS ts) {
  SNES snes;
  KSP ksp;
  PC pc;
  check(TSGetSNES(ts, &snes));
  check(SNESGetKSP(snes, &ksp));
  check(KSPGetPC(ksp, &pc));
  check(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
}

Numbers initial_velocity() { return {2, 1, 0, -1, 0, 2, 0, 1, -1, 0}; }

// What the chain ends at, on all ranks.
Numbers run_distributed(bool adaptive) {
  Run run(chain(), Numbers(masses + 1, 0.0), initial_velocity(), 0.05, 3);
  floe::petsc::TsHandle ts;
  floe::petsc::VecHandle U, V;
  floe::petsc::MatHandle J;
  check(MatCreateAIJ(PETSC_COMM_WORLD, PETSC_DECIDE, PETSC_DECIDE, masses + 1, masses + 1, masses + 1, nullptr,
                     masses + 1, nullptr, J.out()));
  check(MatCreateVecs(J, U.out(), V.out()));
  fill_owned(V, initial_velocity());
  check(TSCreate(PETSC_COMM_WORLD, ts.out()));
  check(TSSetType(ts, generalized_alpha));
  check(TSSetI2Function(ts, nullptr, shared_residual, &run.problem));
  check(TSSetI2Jacobian(ts, J, J, shared_tangent, &run.problem));
  check(TSGeneralizedAlphaSetStart(ts, shared_start, &run.problem));
  check(TS2SetSolution(ts, U, V));
  PetscInt first, last;
  check(VecGetOwnershipRange(U, &first, &last));
  floe::petsc::IsHandle multipliers;
  check(ISCreateStride(PETSC_COMM_WORLD, last == masses + 1 ? 1 : 0, masses, 1, multipliers.out()));
  check(TSGeneralizedAlphaSetMultipliers(ts, multipliers));
  use_mumps(ts);
  check(TSSetTimeStep(ts, 0.05));
  check(TSSetMaxTime(ts, 3));
  check(TSSetExactFinalTime(ts, TS_EXACTFINALTIME_MATCHSTEP));
  if (adaptive) {
    TSAdapt adapt;
    check(TSGetAdapt(ts, &adapt));
    check(TSAdaptSetType(adapt, TSADAPTBASIC));
    check(TSSetTolerances(ts, PETSC_DECIDE, nullptr, 1e-4, nullptr));
  }
  check(TSSolve(ts, U));
  return everywhere(U);
}

}  // namespace

TEST_CASE("generalized-alpha: distributed and sparse equals serial and dense") {
  const bool adaptive = GENERATE(false, true);
  Run serial(chain(), Numbers(masses + 1, 0.0), initial_velocity(), 0.05, 3);
  check(TSSetPostStep(serial.ts, no_record));
  if (adaptive) {
    TSAdapt adapt;
    check(TSGetAdapt(serial.ts, &adapt));
    check(TSAdaptSetType(adapt, TSADAPTBASIC));
    check(TSSetTolerances(serial.ts, PETSC_DECIDE, nullptr, 1e-4, nullptr));
  }
  serial.solve();
  const Numbers expected = numbers(serial.U), found = run_distributed(adaptive);
  CHECK(std::abs(found[0] + 2 * found[masses - 1]) < 1e-13);
  for (size_t i = 0; i < found.size(); ++i) CHECK(found[i] == Approx(expected[i]).epsilon(0).margin(1e-9));
}
