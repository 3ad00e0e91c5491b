#include <algorithm>
#include <catch2/catch.hpp>

#include "generalized_alpha_problem.h"

using namespace floe::solve;
using namespace floe::solve::problems;

namespace {

struct Errors {
  double q = 0, v = 0, lambda = 0;
};

// Greatest errors over all steps, the first ones included.
Errors pendulum_errors(double rho, int steps) {
  const Pendulum pendulum;
  const double angle = 1.5, rate = 0.7, end = 4;
  Run run(pendulum.problem(), pendulum.position(angle), pendulum.velocity(angle, rate), end / steps, end);
  check(TSGeneralizedAlphaSetRadius(run.ts, rho));
  run.solve();
  Errors errors;
  for (size_t i = 0; i < run.t.size(); ++i) {
    const Numbers exact = pendulum.exact(angle, rate, run.t[i]);
    for (size_t d : {0u, 1u}) {
      errors.q = std::max(errors.q, std::abs(run.u[i][d] - exact[d]));
      errors.v = std::max(errors.v, std::abs(run.v[i][d] - exact[3 + d]));
    }
    errors.lambda = std::max(errors.lambda, std::abs(run.u[i][2] - exact[2]));
  }
  return errors;
}

double order(double coarse, double fine) { return std::log2(coarse / fine); }

}  // namespace

TEST_CASE("generalized-alpha: order 2 in q, v and multipliers from the first step on") {
  const double rho = GENERATE(0.9, 0.8, 0.5, 0.0);
  const Errors coarse = pendulum_errors(rho, 200), fine = pendulum_errors(rho, 400);
  INFO("rho " << rho << ", errors " << fine.q << " " << fine.v << " " << fine.lambda);
  CHECK(order(coarse.q, fine.q) == Approx(2).margin(0.1));
  CHECK(order(coarse.v, fine.v) == Approx(2).margin(0.1));
  CHECK(order(coarse.lambda, fine.lambda) == Approx(2).margin(0.1));
}

TEST_CASE("generalized-alpha: constraints hold at round-off") {
  const Pendulum pendulum;
  Run run(pendulum.problem(), pendulum.position(1.5), pendulum.velocity(1.5, 0), 0.05, 20);
  run.solve();
  double drift = 0;
  for (const auto& u : run.u) drift = std::max(drift, std::abs(std::hypot(u[0], u[1]) - 1));
  CHECK(drift < 1e-14);
}

TEST_CASE("generalized-alpha: an oscillator under load converges with order 2 without a start callback") {
  // q = sin(t) for q'' + 0.2 q' + 4 q = 3 sin(t) + 0.2 cos(t)
  const auto error = [](double rho, double h) {
    Run run(oscillator(1, 0.2, 4, [](double t) { return 3 * std::sin(t) + 0.2 * std::cos(t); }), {0}, {1}, h, 3);
    check(TSGeneralizedAlphaSetRadius(run.ts, rho));
    run.solve();
    Errors errors;
    for (size_t i = 0; i < run.t.size(); ++i) {
      errors.q = std::max(errors.q, std::abs(run.u[i][0] - std::sin(run.t[i])));
      errors.v = std::max(errors.v, std::abs(run.v[i][0] - std::cos(run.t[i])));
      errors.lambda = std::max(errors.lambda, std::abs(run.a[i][0] + std::sin(run.t[i])));
    }
    return errors;
  };
  const double rho = GENERATE(0.9, 0.8, 0.5, 0.0);
  const Errors coarse = error(rho, 0.02), fine = error(rho, 0.01);
  CHECK(order(coarse.q, fine.q) == Approx(2).margin(0.1));
  CHECK(order(coarse.v, fine.v) == Approx(2).margin(0.1));
  CHECK(order(coarse.lambda, fine.lambda) == Approx(2).margin(0.1));
}

TEST_CASE("generalized-alpha: the spectral radius at infinite frequency is rho") {
  // All three roots of the amplification matrix tend to -rho (Chung and Hulbert 1993, eq. 25): (z + rho)^3 = 0.
  const double rho = GENERATE(0.9, 0.8, 0.5, 0.2);
  Run run(oscillator(1, 0, 1e16), {1}, {0}, 1, 20);
  check(TSGeneralizedAlphaSetRadius(run.ts, rho));
  run.solve();
  for (size_t i = 3; i + 3 < 20; ++i) {
    const double z0 = run.u[i][0], z1 = run.u[i + 1][0], z2 = run.u[i + 2][0], z3 = run.u[i + 3][0];
    const double size =
        std::abs(z3) + 3 * rho * std::abs(z2) + 3 * rho * rho * std::abs(z1) + rho * rho * rho * std::abs(z0);
    CHECK(std::abs(z3 + 3 * rho * z2 + 3 * rho * rho * z1 + rho * rho * rho * z0) < 1e-6 * size);
  }
}

TEST_CASE("generalized-alpha: a stiff motion at the start is damped, not amplified") {
  Run run(oscillator(1, 0, 1e12), {0}, {1}, 1, 60);
  run.solve();
  double greatest = 0;
  for (const auto& v : run.v) greatest = std::max(greatest, std::abs(v[0]));
  CHECK(greatest < 4);
  CHECK(std::abs(run.v.back()[0]) < 1e-2);
}

TEST_CASE("generalized-alpha: steps of a millionth of the period") {
  const Pendulum pendulum;
  const double h = 2 * M_PI * 1e-6;
  Run run(pendulum.problem(), pendulum.position(1), pendulum.velocity(1, 0.5), h, 300 * h);
  run.solve();
  PetscInt iterations;
  check(TSGetSNESIterations(run.ts, &iterations));
  CHECK(iterations <= 3 * 300);
  const Numbers exact = pendulum.exact(1, 0.5, run.t.back());
  CHECK(run.u.back()[0] == Approx(exact[0]).epsilon(1e-13));
  CHECK(run.v.back()[0] == Approx(exact[3]).epsilon(1e-9));
  // eps |q| / (beta h^2) of the accelerations, here 2e-5, is round-off of the positions themselves
  CHECK(run.u.back()[2] == Approx(exact[2]).epsilon(1e-3));
}

TEST_CASE("generalized-alpha: units do not matter") {
  const auto final_state = [](double mass, double length, double gravity, bool adaptive) {
    const Pendulum p{mass, length, gravity};
    const double T = p.time_unit();
    Run run(p.problem(), p.position(1.2), p.velocity(1.2, 0.3 / T), 0.05 * T, 5 * T);
    if (adaptive) {
      TSAdapt adapt;
      check(TSGetAdapt(run.ts, &adapt));
      check(TSAdaptSetType(adapt, TSADAPTBASIC));
      check(TSSetTolerances(run.ts, PETSC_DECIDE, nullptr, 1e-5, nullptr));
    }
    run.solve();
    const Numbers u = run.u.back(), v = run.v.back();
    return Numbers{u[0] / length, u[1] / length, u[2] / (mass * gravity), v[0] / (length / T), double(run.t.size())};
  };
  const bool adaptive = GENERATE(false, true);
  const double mass = GENERATE(1e-9, 1e9), length = GENERATE(1e-9, 1e9), gravity = GENERATE(1e-9, 1e9);
  const Numbers one = final_state(1, 1, 1, adaptive), other = final_state(mass, length, gravity, adaptive);
  // The multiplier's round-off is eps |q| / (beta h^2), some 1e-10 where steps adapt, whatever Newton's tolerance.
  for (size_t i = 0; i < one.size(); ++i) CHECK(other[i] == Approx(one[i]).epsilon(0).margin(i == 2 ? 3e-10 : 1e-11));
}

TEST_CASE("generalized-alpha: rest stays at rest, and tiny motions are as good as great ones") {
  SECTION("no load") {
    const bool adaptive = GENERATE(false, true);
    Run run(oscillator(2, 0.1, 3), {0}, {0}, 0.1, 2);
    if (adaptive) {
      TSAdapt adapt;
      check(TSGetAdapt(run.ts, &adapt));
      check(TSAdaptSetType(adapt, TSADAPTBASIC));
    }
    run.solve();
    CHECK(run.t.size() >= 20);
    for (size_t i = 0; i < run.t.size(); ++i) CHECK((run.u[i][0] == 0 && run.v[i][0] == 0 && run.a[i][0] == 0));
  }
  SECTION("a hanging pendulum") {
    const Pendulum pendulum{1, 1, 9.81};
    Run run(pendulum.problem(), {0, -1, 0}, {0, 0, 0}, 0.01, 1);
    run.solve();
    for (const auto& u : run.u) CHECK((u[0] == 0 && u[1] == -1 && u[2] == Approx(9.81).epsilon(1e-12)));
  }
  SECTION("amplitude 1e-12") {
    const auto final_value = [](double amplitude) {
      Run run(oscillator(1, 0, 1), {amplitude}, {0}, 0.05, 3);
      run.solve();
      return run.u.back()[0] / amplitude;
    };
    CHECK(final_value(1e-12) == Approx(final_value(1)).epsilon(1e-12));
  }
}

TEST_CASE("generalized-alpha: rho outside [0, 1) is refused") {
  Run run(oscillator(1, 0, 1), {1}, {0}, 0.1, 1);
  CHECK_THROWS_WITH(check(TSGeneralizedAlphaSetRadius(run.ts, 1)), Catch::Contains("must be in [0, 1)"));
  CHECK_THROWS(check(TSGeneralizedAlphaSetRadius(run.ts, -0.1)));
}

TEST_CASE("generalized-alpha: the radius is an option with the prefix of the TS") {
  Run run(oscillator(1, 0, 1e16), {1}, {0}, 1, 40);
  check(TSSetOptionsPrefix(run.ts, "motion_"));
  check(PetscOptionsSetValue(nullptr, "-motion_ts_generalized_alpha_radius", "0.1"));
  check(TSSetFromOptions(run.ts));
  check(PetscOptionsClearValue(nullptr, "-motion_ts_generalized_alpha_radius"));
  run.solve();
  CHECK(std::abs(run.u[20][0]) < 1e-12);  // 0.1^21 times a polynomial; 0.8^21 is 0.01
}

TEST_CASE("generalized-alpha: constraints without a start callback are refused") {
  Problem problem = Pendulum().problem();
  problem.start = nullptr;
  Run run(problem, {1, 0, 0}, {0, 0, 0}, 0.1, 1);
  CHECK_THROWS_WITH(run.solve(), Catch::Contains("TSGeneralizedAlphaSetStart"));
}
