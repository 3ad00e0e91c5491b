#include <catch2/catch.hpp>
#include <optional>

#include "spatial_systems.h"

using namespace floe;
using testing::numbers_of;
using testing::vector_of;

namespace {

/// A damped spring between the rod's end and a point: something to make Newton work.
testing::Terms spring() {
  testing::Terms terms;
  terms.push_back(std::make_unique<dynamics::Spring>(dynamics::Marker::ground({1, -2}), testing::on_rod(1.5),
                                                     dynamics::SpringProperties{400, 0.5, 0.3, 0, 0, 0}));
  return terms;
}

struct Trace {
  std::vector<double> numbers;  // times and states of every step
  std::optional<solve::MotionState> state;
  solve::IntegrationReport report;
};

/// From the start, or from a state; keeps the state after step `keep`.
Trace swing(const dynamics::System& system, const std::vector<double>& at, const std::vector<double>& rates,
            solve::Integration how, PetscInt keep, PetscInt from_step) {
  const petsc::VecHandle U = vector_of(system, at), V = vector_of(system, rates);
  Trace trace;
  trace.report = solve::simulate(system, how, U, V, [&](const solve::Instant& now) {
    REQUIRE(now.state);
    if (now.step == keep) trace.state = (*now.state)();
    if (now.step <= from_step) return;
    trace.numbers.push_back(now.t);
    for (const Vec v : {now.U, now.V})
      for (const double x : numbers_of(v)) trace.numbers.push_back(x);
  });
  return trace;
}

}  // namespace

TEST_CASE("a motion that is taken up from a state is the same to the last bit") {
  const std::optional<double> tolerance = GENERATE(std::optional<double>(), std::optional<double>(1e-6));
  const PetscInt keep = GENERATE(0, 1, 7, 50);
  solve::Integration how{1.5, 0.01, 0.8, tolerance};
  const dynamics::System system = testing::pendulum(2, 1.5, 9.81, spring());
  const std::vector<double> at{0, 0, 0.3, 0, 0}, rates(5, 0.0);
  const Trace whole = swing(system, at, rates, how, keep, keep);
  REQUIRE(whole.state);
  const dynamics::System again = testing::pendulum(2, 1.5, 9.81, spring());
  how.from = &*whole.state;
  const Trace rest = swing(again, std::vector<double>(5, 0.0), rates, how, -1, keep);
  CHECK(rest.numbers == whole.numbers);
  CHECK(rest.report.steps == whole.report.steps);
  CHECK(rest.report.newton == whole.report.newton);
}

TEST_CASE("a motion that is taken up before its last step ends as if it had not been") {
  // what is left is halved, and begins of steps are sums: the second half misses the end by round-off
  const dynamics::System system = testing::pendulum(2, 1.5, 9.81, spring()),
                         again = testing::pendulum(2, 1.5, 9.81, spring());
  const std::vector<double> at{0, 0, 0.3, 0, 0}, rates(5, 0.0);
  for (int i = 0; i < 40; ++i) {
    solve::Integration how{0.2003 + 0.00037 * i, 0.01, 0.8, {}};
    const PetscInt steps = swing(system, at, rates, how, -1, 0).report.steps;
    const Trace whole = swing(system, at, rates, how, steps - 1, steps - 1);
    how.from = &*whole.state;
    CHECK(swing(again, std::vector<double>(5, 0.0), rates, how, -1, steps - 1).numbers == whole.numbers);
  }
}

TEST_CASE("a motion that goes on beyond its end takes whole steps") {
  const PetscInt keep = GENERATE(19, 20, 21);  // at the end, and before the halves
  const dynamics::System system = testing::pendulum(2, 1.5, 9.81, spring()),
                         again = testing::pendulum(2, 1.5, 9.81, spring());
  const std::vector<double> at{0, 0, 0.3, 0, 0}, rates(5, 0.0);
  solve::Integration how{0.205, 0.01, 0.8, {}};  // 19 steps, and what is left in two
  const Trace first = swing(system, at, rates, how, keep, 0);
  REQUIRE(first.report.steps == 21);
  how.from = &*first.state;
  how.end = 0.305;
  CHECK(swing(again, std::vector<double>(5, 0.0), rates, how, -1, 0).report.steps == 31);
}

TEST_CASE("a spinning top is taken up with its attitude") {
  const PetscInt keep = GENERATE(3, 40);
  const auto top = [] {
    auto attitude = std::make_shared<dynamics::Attitude>();
    attitude->base = Eigen::Quaterniond(Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitX()));
    dynamics::Coordinates coordinates(PETSC_COMM_SELF);
    coordinates.add_shared(6);
    coordinates.add_shared(3, true);
    coordinates.number();
    testing::Terms terms;
    terms.push_back(std::make_unique<dynamics::SpatialBody>(
        std::vector<int>{0, 1, 2, 3, 4, 5}, attitude, testing::rigid(2, {0.3, 0.35, 0.1}), testing::no_elasticity()));
    terms.push_back(std::make_unique<testing::HeavyOnPoint>(attitude, Eigen::Vector3d(0, 0, -0.5), 20));
    return dynamics::System(std::move(coordinates), std::move(terms), {{3, attitude}});
  };
  const auto at = [](const dynamics::System& system) {
    const Eigen::Vector3d R = system.attitudes()[0].second->base * Eigen::Vector3d(0, 0, 0.5);
    return std::vector<double>{R.x(), R.y(), R.z(), 0, 0, 0, 0, 0, 0};
  };
  const std::vector<double> rates{0, 0, 0, 0, 0, 30, 0, 0, 0};
  solve::Integration how{0.5, 5e-3, 0.8, {}};
  const dynamics::System system = top();
  const Trace whole = swing(system, at(system), rates, how, keep, keep);
  REQUIRE(whole.state);
  const dynamics::System again = top();
  how.from = &*whole.state;
  const Trace rest = swing(again, at(again), rates, how, -1, keep);
  CHECK(rest.numbers == whole.numbers);
  CHECK(again.attitudes()[0].second->base.coeffs() == system.attitudes()[0].second->base.coeffs());
}

TEST_CASE("a state of another system is refused") {
  solve::Integration how{0.1, 0.01, 0.8, {}};
  const dynamics::System system = testing::pendulum(2, 1.5, 9.81);
  const std::vector<double> zero(5, 0.0);
  Trace whole = swing(system, zero, zero, how, 4, 0);
  solve::MotionState state = *whole.state;
  state.vectors.front().second.pop_back();
  how.from = &state;
  CHECK_THROWS_WITH(swing(system, zero, zero, how, -1, 0), Catch::Contains("another system"));
  state = *whole.state;
  state.carried.push_back(1);
  CHECK_THROWS_WITH(swing(system, zero, zero, how, -1, 0), Catch::Contains("another system"));
}
