#include <algorithm>
#include <catch2/catch.hpp>

#include "generalized_alpha_problem.h"

using namespace floe::solve::problems;

namespace {

void adapt_to(Run& run, double rtol) {
  TSAdapt adapt;
  check(TSGetAdapt(run.ts, &adapt));
  check(TSAdaptSetType(adapt, TSADAPTBASIC));
  check(TSSetTolerances(run.ts, PETSC_DECIDE, nullptr, rtol, nullptr));
}

// A pendulum that passes the vertical at t_e has its velocity reversed there, and runs back: q(t) = q(2 t_e - t).
PetscErrorCode at_vertical(TS, PetscReal, Vec U, PetscScalar* value, void*) {
  value[0] = numbers(U)[0];
  return 0;
}
PetscErrorCode reverse(TS ts, PetscInt, PetscInt*, PetscReal t, Vec U, PetscBool, void* context) {
  Vec V;
  *static_cast<double*>(context) = t;
  check(TS2GetSolution(ts, nullptr, &V));
  check(VecScale(V, -1));
  check(VecScale(U, 1));
  return 0;
}

struct Bounce {
  double time = 0, q = 0, lambda = 0;
};

Bounce bounce(double h, bool adaptive) {
  const Pendulum pendulum;
  Bounce errors;
  double hit = 0;
  Run run(pendulum.problem(), pendulum.position(1), pendulum.velocity(1, 0), h, 3);
  PetscInt direction = 0;
  PetscBool terminate = PETSC_FALSE;
  check(TSSetEventHandler(run.ts, 1, &direction, &terminate, at_vertical, reverse, &hit));
  check(TSSetEventTolerances(run.ts, 1e-11, nullptr));
  if (adaptive) adapt_to(run, 1e-6);
  run.solve();
  // Quarter period of the pendulum released at 1 rad: K(sin(1/2)).
  const double t_e = std::comp_ellint_1(std::sin(0.5));
  errors.time = std::abs(hit - t_e);
  for (size_t i = 0; i < run.t.size(); ++i) {
    const Numbers exact = pendulum.exact(1, 0, std::min(run.t[i], std::abs(2 * t_e - run.t[i])));
    errors.q = std::max(errors.q, std::abs(run.u[i][0] - exact[0]));
    errors.lambda = std::max(errors.lambda, std::abs(run.u[i][2] - exact[2]));
  }
  return errors;
}

}  // namespace

TEST_CASE("generalized-alpha: an event is located and the motion after it keeps order 2") {
  const Bounce coarse = bounce(0.02, false), fine = bounce(0.01, false);
  INFO(coarse.time << " " << fine.time << ", " << coarse.q << " " << fine.q << ", " << coarse.lambda << " "
                   << fine.lambda);
  CHECK(fine.time < 1e-4);
  CHECK(std::log2(coarse.time / fine.time) == Approx(2).margin(0.15));
  CHECK(std::log2(coarse.q / fine.q) == Approx(2).margin(0.15));
  CHECK(std::log2(coarse.lambda / fine.lambda) == Approx(2).margin(0.25));
  CHECK(bounce(0.01, true).q < 1e-3);
}

TEST_CASE("generalized-alpha: the adaptive step follows the tolerance") {
  const auto run_with = [](double rtol, double h) {
    const Pendulum pendulum;
    Run run(pendulum.problem(), pendulum.position(1.5), pendulum.velocity(1.5, 0), h, 10);
    adapt_to(run, rtol);
    run.solve();
    const Numbers exact = pendulum.exact(1.5, 0, run.t.back());
    CHECK(run.t.back() == Approx(10));
    return std::pair(std::hypot(run.u.back()[0] - exact[0], run.u.back()[1] - exact[1]), run.t.size());
  };
  const auto [loose, few] = run_with(1e-4, 0.01);
  const auto [tight, many] = run_with(1e-7, 0.01);
  // error ~ rtol^(2/3), steps ~ rtol^(-1/3)
  CHECK(loose < 1000e-4);
  CHECK(loose / tight == Approx(100).epsilon(0.5));
  CHECK(double(many) / double(few) == Approx(10).epsilon(0.3));
  CHECK(run_with(1e-5, 3.0).first < 1000e-5);   // a first step of half a period is cut
  CHECK(run_with(1e-5, 1e-6).first < 1000e-5);  // a far too short one grows
}

TEST_CASE("generalized-alpha: from rest under a load that grows from zero, adaptively") {
  // q'' + q = t: q = t - sin t
  Run run(oscillator(1, 0, 1, [](double t) { return t; }), {0}, {0}, 0.01, 10);
  adapt_to(run, 1e-6);
  run.solve();
  CHECK(run.u.back()[0] == Approx(10 - std::sin(10.)).epsilon(1e-4));
  CHECK(run.t.size() < 1000);
}

TEST_CASE("generalized-alpha: a Newton solve that fails") {
  // No solution once the force of the spring, bounded by 1, is less than the load.
  Problem problem = oscillator(1e-9, 0, 0);
  problem.residual = [](double t, const double* u, const double*, const double* a, double* f) {
    f[0] = 1e-9 * a[0] + std::tanh(u[0]) - (t > 0.5 ? NAN : 0.1 * t);
  };
  problem.tangent = [](double, const double* u, const double*, const double*, double, double sa, double* J) {
    J[0] = sa * 1e-9 + 1 / std::pow(std::cosh(u[0]), 2);
  };
  Run run(problem, {0}, {0}, 0.1, 1);
  check(TSSetErrorIfStepFails(run.ts, PETSC_FALSE));
  TSConvergedReason reason;
  SECTION("with a fixed step ends the motion with its state kept") {
    run.solve();
    check(TSGetConvergedReason(run.ts, &reason));
    CHECK(reason == TS_DIVERGED_NONLINEAR_SOLVE);
    CHECK(run.t.size() == 5);
    CHECK(numbers(run.U)[0] == run.u.back()[0]);
  }
  SECTION("with an adaptive step cuts it, max_reject times") {
    adapt_to(run, 1e3);
    check(TSSetMaxStepRejections(run.ts, 6));
    run.solve();
    check(TSGetConvergedReason(run.ts, &reason));
    CHECK(reason == TS_DIVERGED_STEP_REJECTED);
    CHECK(run.t.back() > 0.45);
  }
}

TEST_CASE("generalized-alpha: a Jacobian kept over many steps gives the same motion") {
  const Pendulum pendulum;
  const auto final_state = [&](bool lag, PetscInt* jacobians) {
    Run run(pendulum.problem(), pendulum.position(1.5), pendulum.velocity(1.5, 0), 0.01, 5);
    SNES snes;
    check(TSGetSNES(run.ts, &snes));
    if (lag) {
      check(SNESSetLagJacobian(snes, 20));
      check(SNESSetLagJacobianPersists(snes, PETSC_TRUE));
      check(SNESSetLagPreconditioner(snes, 20));
      check(SNESSetLagPreconditionerPersists(snes, PETSC_TRUE));
    }
    int count = 0;
    auto counted = run.problem.tangent;
    run.problem.tangent = [&](double t, const double* u, const double* v, const double* a, double sv, double sa,
                              double* J) { ++count, counted(t, u, v, a, sv, sa, J); };
    run.solve();
    *jacobians = count;
    return run.u.back();
  };
  PetscInt each, few;
  const Numbers exact = final_state(false, &each), lagged = final_state(true, &few);
  CHECK(few < each / 3);
  for (size_t i : {0u, 1u, 2u}) CHECK(lagged[i] == Approx(exact[i]).epsilon(1e-6));
}

TEST_CASE("generalized-alpha: interpolation between steps is as good as the steps") {
  const Pendulum pendulum;
  const auto error = [&](double h) {
    Run run(pendulum.problem(), pendulum.position(1.5), pendulum.velocity(1.5, 0), h, 10);
    check(TSSetExactFinalTime(run.ts, TS_EXACTFINALTIME_STEPOVER));
    check(TSSetMaxTime(run.ts, 2));
    run.solve();
    PetscReal end;
    check(TSGetTime(run.ts, &end));
    const auto between = vector({0, 0, 0});
    check(TSInterpolate(run.ts, end - 0.4 * h, between));
    const Numbers exact = pendulum.exact(1.5, 0, end - 0.4 * h), u = numbers(between);
    return std::pair(std::hypot(u[0] - exact[0], u[1] - exact[1]), std::abs(u[2] - exact[2]));
  };
  const auto [q_coarse, lambda_coarse] = error(0.04);
  const auto [q_fine, lambda_fine] = error(0.01);
  CHECK(std::log2(q_coarse / q_fine) / 2 == Approx(2).margin(0.2));
  CHECK(std::log2(lambda_coarse / lambda_fine) / 2 == Approx(2).margin(0.3));
}

// a + c (v - 1 - t) = 0, c h = 1e3, from rest: v follows 1 + t; a alternates, and h a is greater than v.
TEST_CASE("generalized-alpha: rates between steps of a strongly damped motion do not leave those at the steps") {
  const double c = 1e5, h = 0.01;
  Problem damper;
  damper.size = 1;
  damper.residual = [c](double t, const double*, const double* v, const double* a, double* f) {
    f[0] = a[0] + c * (v[0] - 1 - t);
  };
  damper.tangent = [c](double, const double*, const double*, const double*, double sv, double sa, double* J) {
    J[0] += sa + c * sv;
  };
  Run run(damper, {0}, {0}, h, 24 * h);
  run.solve();
  REQUIRE(run.v.size() == 24);
  const double v0 = run.v[22][0], v1 = run.v[23][0];
  CHECK(v1 == Approx(1.24).margin(0.02));
  CHECK(std::abs(run.a[23][0] - run.a[22][0]) * h / 8 > 0.2);  // what a cubic polynomial would add
  const auto U = vector({0}), V = vector({0}), A = vector({0});
  for (const double x : {0.25, 0.5, 0.75}) {
    check(floe::solve::TSGeneralizedAlphaInterpolate(run.ts, (23 + x) * h, U, V, A));
    CHECK(numbers(V)[0] == Approx(v0 + x * (v1 - v0)).margin(0.07 * v1));
  }
}
