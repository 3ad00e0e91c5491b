#include "floe/solve/simulation.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "systems.h"

using namespace floe;
using testing::numbers_of;
using testing::vector_of;

namespace {

const double m = 2, l = 1.5, g = 9.81;

struct Sample {
  double t, theta, w;
};

std::vector<Sample> swing(double theta, const solve::Integration& how, double* drift = nullptr) {
  const dynamics::System system = testing::pendulum(m, l, g);
  const petsc::VecHandle U = vector_of(system, {0, 0, theta, 0, 0}), V = system.create_vector();
  std::vector<Sample> samples;
  double first = 0;
  solve::simulate(system, how, U, V, [&](const solve::Instant& now) {
    samples.push_back({now.t, numbers_of(now.U)[2], numbers_of(now.V)[2]});
    const dynamics::Energy energy = system.energy(now.t, now.U, now.V);
    const double total = energy.kinetic + energy.potential;
    if (samples.size() == 1) first = total;
    if (drift) *drift = std::max(*drift, std::abs(total - first));
  });
  return samples;
}

}  // namespace

TEST_CASE("a compound pendulum is at its lowest after a quarter period of the elliptic integral") {
  // released at rest, horizontal: amplitude 90 degrees, T = 4 K(sin 45) sqrt(2 l / 3 g)
  const double pi = std::acos(-1.), quarter = std::comp_ellint_1(std::sin(pi / 4)) * std::sqrt(2 * l / (3 * g));
  const auto error = [&](double step, double* drift) {
    return std::abs(swing(0, {quarter, step, 0.8, {}}, drift).back().theta + pi / 2);
  };
  double coarse_drift = 0, fine_drift = 0;
  const double coarse = error(quarter / 100, &coarse_drift), fine = error(quarter / 200, &fine_drift);
  CHECK(fine < 1e-4);
  CHECK(std::log2(coarse / fine) == Approx(2).margin(0.1));
  CHECK(fine_drift < 1e-3 * m * g * l);
  CHECK(std::log2(coarse_drift / fine_drift) == Approx(2).margin(0.2));
}

TEST_CASE("the observer sees the start, every step and the end once") {
  const dynamics::System system = testing::pendulum(m, l, g);
  const petsc::VecHandle U = system.create_vector(), V = system.create_vector();
  std::vector<double> times;
  std::vector<PetscInt> steps;
  int last = 0;
  const auto report = solve::simulate(system, {0.1, 0.03, 0.8, {}}, U, V, [&](const solve::Instant& now) {
    times.push_back(now.t), steps.push_back(now.step), last += now.last;
    CHECK((now.A == nullptr) == (now.step == 0));  // the type hands them out from the first step on
  });
  REQUIRE(times.size() == 5);  // 0, .03, .06, .09, .1: the last step is cut
  CHECK(times.front() == 0);
  CHECK(times.back() == Approx(0.1).epsilon(1e-14));
  CHECK(steps == std::vector<PetscInt>{0, 1, 2, 3, 4});
  CHECK(last == 1);
  CHECK(report.steps == 4);
  CHECK(report.end == Approx(0.1).epsilon(1e-14));
  CHECK(report.newton >= 4);
  CHECK(report.type == "generalized-alpha");
}

TEST_CASE("the equations hold at the end of every step") {
  const dynamics::System system = testing::pendulum(m, l, g);
  const petsc::VecHandle U = system.create_vector(), V = system.create_vector(), F = system.create_vector();
  solve::simulate(system, {0.05, 0.01, 0.8, {}}, U, V, [&](const solve::Instant& now) {
    if (now.step == 0) return;
    system.residual(now.t, now.U, now.V, now.A, dynamics::ConstraintLevel::position, F);
    CHECK(numbers_of(F).cwiseAbs().maxCoeff() < 1e-8 * m * g);
    const double theta = numbers_of(now.U)[2];
    CHECK(numbers_of(now.A)[2] == Approx(-1.5 * g / l * std::cos(theta)).epsilon(1e-4));
  });
}

TEST_CASE("an adaptive step takes few steps to a given tolerance") {
  const auto loose = swing(0, {1, 1e-3, 0.8, 1e-3}), tight = swing(0, {1, 1e-3, 0.8, 1e-6});
  CHECK(loose.size() < tight.size() / 3);
  CHECK(loose.back().theta == Approx(tight.back().theta).epsilon(1e-2));
  CHECK(loose.back().t == Approx(1));
}

TEST_CASE("what the observer throws ends the motion: an input error as it is, all else with the time it stopped at") {
  const bool input = GENERATE(true, false);
  const dynamics::System system = testing::pendulum(m, l, g);
  const petsc::VecHandle U = system.create_vector(), V = system.create_vector();
  int seen = 0;
  const auto run = [&] {
    solve::simulate(system, {1, 0.01, 0.8, {}}, U, V, [&](const solve::Instant& now) {
      ++seen;
      if (now.step == 3 && input) throw InputError("the disk is full");
      if (now.step == 3) throw std::runtime_error("the disk is full");
    });
  };
  if (input)
    CHECK_THROWS_AS(run(), InputError);
  else
    CHECK_THROWS_AS(run(), solve::MotionStopped);
  CHECK(seen == 4);
  seen = 0;
  CHECK_THROWS_WITH(run(), Catch::Contains("the disk is full"));
}

TEST_CASE("what a term throws ends the motion at the last state that was reached") {
  testing::Terms bad;
  bad.push_back(std::make_unique<dynamics::Force>(
      testing::on_rod(l),
      [](double t) -> Eigen::Vector3d {
        if (t > 0.055) throw std::domain_error("no value");
        return {0, 0, 0};
      },
      dynamics::Force::Axes::world));
  const dynamics::System system = testing::pendulum(m, l, g, std::move(bad));
  const petsc::VecHandle U = system.create_vector(), V = system.create_vector();
  Eigen::VectorXd seen;
  const auto observe = [&](const solve::Instant& now) { seen = numbers_of(now.U); };
  CHECK_THROWS_WITH(solve::simulate(system, {1, 0.01, 0.8, {}}, U, V, observe),
                    Catch::Contains("t = 0.05 of 1") && Catch::Contains("no value"));
  CHECK(numbers_of(U) == seen);
}

TEST_CASE("a step that does not converge stops the motion: what was tried, when, and the state kept") {
  testing::Terms bad;
  bad.push_back(std::make_unique<dynamics::Force>(
      testing::on_rod(l), [](double t) { return Eigen::Vector3d(0, 0, t > 0.055 ? std::nan("") : 0); },
      dynamics::Force::Axes::world));
  const dynamics::System system = testing::pendulum(m, l, g, std::move(bad));
  const petsc::VecHandle U = system.create_vector(), V = system.create_vector();
  Eigen::VectorXd seen;
  try {
    solve::simulate(system, {1, 0.01, 0.8, {}}, U, V, [&](const solve::Instant& now) { seen = numbers_of(now.U); });
    FAIL("no exception");
  } catch (const solve::MotionStopped& stopped) {
    CHECK(stopped.report().end == Approx(0.05));
    CHECK(stopped.report().steps == 5);
    CHECK_THAT(stopped.what(), Catch::Contains("t = 0.05 of 1"));
  }
  CHECK(numbers_of(U) == seen);
  CHECK(seen.allFinite());
}
