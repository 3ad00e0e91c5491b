#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "generalized_alpha_problem.h"

using namespace floe::solve;
using namespace floe::solve::problems;

namespace {

/// A pendulum that swings through a large angle in few steps, its Jacobian kept for `lag` Newton iterations.
Numbers swing(PetscInt lag, double step, TSConvergedReason* reason) {
  const Pendulum pendulum;
  Run run(pendulum.problem(), pendulum.position(2.8), pendulum.velocity(2.8, 0.5), step, 12);
  SNES snes;
  check(TSGetSNES(run.ts, &snes));
  check(SNESSetLagJacobian(snes, lag));
  check(SNESSetLagJacobianPersists(snes, PETSC_TRUE));
  run.solve();
  check(TSGetConvergedReason(run.ts, reason));
  return run.u.back();
}

struct Effort {
  PetscInt steps = 0, iterations = 0, jacobians = 0;
  PetscInt amid = 0;  ///< Jacobians after the first iteration of a step
};

/// A smooth motion over 15 s, its Jacobian kept for 20 iterations and from step to step.
Effort move_smoothly(const Problem& problem, const Numbers& u, const Numbers& v, double step) {
  Run run(problem, u, v, step, 15);
  SNES snes;
  Effort effort;
  check(TSGetSNES(run.ts, &snes));
  check(SNESSetLagJacobian(snes, 20));
  check(SNESSetLagJacobianPersists(snes, PETSC_TRUE));
  const auto tangent = run.problem.tangent;
  run.problem.tangent = [&](double t, const double* u_, const double* v_, const double* a, double sv, double sa,
                            double* J) {
    PetscInt iteration = 0;
    check(SNESGetIterationNumber(snes, &iteration));
    ++effort.jacobians, effort.amid += iteration > 0;
    tangent(t, u_, v_, a, sv, sa, J);
  };
  run.solve();
  check(TSGetStepNumber(run.ts, &effort.steps));
  check(TSGetSNESIterations(run.ts, &effort.iterations));
  return effort;
}

/// u'' + 400 (u + u^3) = 0
Problem hardening() {
  Problem problem;
  problem.size = 1;
  problem.residual = [](double, const double* u, const double*, const double* a, double* f) {
    f[0] = a[0] + 400 * (u[0] + u[0] * u[0] * u[0]);
  };
  problem.tangent = [](double, const double* u, const double*, const double*, double, double sa, double* J) {
    J[0] = sa + 400 * (1 + 3 * u[0] * u[0]);
  };
  return problem;
}

}  // namespace

// The tension changes sign and the rod rotates by half a circle within two steps: a Jacobian from before sends Newton
// away from the solution.
TEST_CASE("generalized-alpha: a step that a kept Jacobian leads astray is made with new ones") {
  const double step = GENERATE(0.1, 0.3, 0.6);
  TSConvergedReason full, kept;
  const Numbers expected = swing(1, step, &full), found = swing(1000, step, &kept);
  REQUIRE(full > 0);
  REQUIRE(kept > 0);
  for (size_t i : {0u, 1u, 2u}) CHECK(found[i] == Approx(expected[i]).epsilon(1e-6).margin(1e-6));
}

// Begun with a_1 = a_0 the error of the first guess is h A' of A, some hundredth; continued it is the square of that.
TEST_CASE("generalized-alpha: Newton starts from accelerations that are continued") {
  const Effort effort = move_smoothly(hardening(), {1}, {0}, 0.002);
  CHECK(effort.iterations < 2.5 * effort.steps);  // 2.7 from a_1 = a_0
}

TEST_CASE("generalized-alpha: a Jacobian whose lag has passed is made anew where a step begins") {
  const Pendulum pendulum;
  const Effort effort = move_smoothly(pendulum.problem(), pendulum.position(1.5), pendulum.velocity(1.5, 0.3), 0.005);
  CHECK(effort.jacobians > effort.iterations / 30);
  CHECK(effort.amid == 0);
}

// A of the first guess errs by h^3 A''' after some steps of one size (by h^2 A'' without the step before). Of a single
// unknown nothing is extrapolated where its acceleration changes sign: the median of the instants counts.
TEST_CASE("generalized-alpha: accelerations are continued to third order over steps of one size") {
  const auto first_residual = [](double step) {
    Run run(hardening(), {1}, {0}, step, 2);
    SNES snes;
    std::vector<double> all;
    check(TSGetSNES(run.ts, &snes));
    const auto residual = run.problem.residual;
    run.problem.residual = [&](double t, const double* u, const double* v, const double* a, double* f) {
      PetscInt iteration = 0;
      check(SNESGetIterationNumber(snes, &iteration));
      residual(t, u, v, a, f);
      if (iteration == 0 && t > 0.5) all.push_back(std::abs(f[0]));
    };
    run.solve();
    std::nth_element(all.begin(), all.begin() + all.size() / 2, all.end());
    return all[all.size() / 2];
  };
  const double order = std::log2(first_residual(0.002) / first_residual(0.001));
  CHECK(order > 2.8);
  CHECK(order < 3.3);
}
