#include "floe/solve/deviation.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "spatial_systems.h"

using namespace floe;
using Eigen::Vector3d;
using Eigen::VectorXd;
using testing::numbers_of;
using testing::vector_of;

namespace {

using States = std::vector<solve::State>;

States states_of(const dynamics::System& system, Vec U, Vec V, const solve::Integration& how) {
  States states;
  solve::simulate(system, how, U, V, [&](const solve::Instant& now) {
    if (now.A) states.push_back(solve::state_of(system, now.t, now.U, now.V, now.A));
  });
  return states;
}

/// Every `n`-th state, so that the step is n times as long.
States every(const States& states, std::size_t n) {
  States some;
  for (std::size_t i = n; i <= states.size(); i += n) some.push_back(states[i - 1]);
  return some;
}

const double m = 2, l = 0.5, g = 9.81;

/// A heavy top on its point, which spins and precesses; unknowns (R, x, lambda).
struct Top {
  std::shared_ptr<dynamics::Attitude> attitude = std::make_shared<dynamics::Attitude>();
  std::unique_ptr<dynamics::System> system;

  explicit Top(double gravity) {
    dynamics::Coordinates coordinates(PETSC_COMM_SELF);
    coordinates.add_shared(6);
    coordinates.add_shared(3, true);
    coordinates.number();
    attitude->base = Eigen::AngleAxisd(0.6, Vector3d::UnitX());
    testing::Terms terms;
    terms.push_back(std::make_unique<dynamics::SpatialBody>(
        std::vector<int>{0, 1, 2, 3, 4, 5}, attitude, testing::rigid(m, {0.2, 0.2, 0.3}), testing::no_elasticity()));
    terms.push_back(std::make_unique<testing::HeavyOnPoint>(attitude, Vector3d(0, 0, -l), m * gravity));
    system = std::make_unique<dynamics::System>(coordinates, std::move(terms), dynamics::Attitudes{{3, attitude}});
  }
  States moved(double end, double step) const {
    const Vector3d w(0, 1, 12), c(0, 0, l), R = attitude->base * c, Rd = attitude->base * w.cross(c);
    return states_of(*system, vector_of(*system, {R[0], R[1], R[2], 0, 0, 0, 0, 0, 0}),
                     vector_of(*system, {Rd[0], Rd[1], Rd[2], w[0], w[1], w[2], 0, 0, 0}), {end, step, 0.8, {}});
  }
};

}  // namespace

// The motion under g is known; the equations have 1.001 g. To first order what is missing is the difference of the two
// motions; the pendulum falls from the horizontal through four swings.
TEST_CASE("deviation: the missing part of a pendulum's motion, at order 2 in steps that are longer than the motion's") {
  const dynamics::System known = testing::pendulum(m, l, g), whole = testing::pendulum(m, l, 1.001 * g);
  const solve::Integration how{3, 1e-3, 0.8, {}};
  const States from = states_of(known, known.create_vector(), known.create_vector(), how),
               to = states_of(whole, whole.create_vector(), whole.create_vector(), how);
  const auto error = [&](std::size_t n) {
    double difference = 0, size = 0;
    const States exact = every(to, n);
    std::size_t i = 0;
    const auto report = solve::deviation(
        whole, 0, every(from, n), [&](const solve::State& at, const VectorXd& d, const VectorXd&, const VectorXd&) {
          const double gap = exact[i++].q[2] - at.q[2];
          difference += std::pow(d[2] - gap, 2), size += gap * gap;
        });
    CHECK(report.end == Approx(3));
    CHECK(report.factorisations < report.steps);
    return std::sqrt(difference / size);
  };
  const double coarse = error(20), fine = error(10);
  CHECK(fine < 0.005);
  CHECK(std::log2(coarse / fine) == Approx(2).margin(0.4));
  CHECK(error(100) < 0.35);  // sixteen steps a swing
}

// Another attitude deviates by A exp(d): checked against the top that has the missing weight.
TEST_CASE("deviation: of a spinning top, in the group of rotations") {
  const Top known(g), whole(1.001 * g);
  const States from = known.moved(1, 5e-4), to = whole.moved(1, 5e-4);
  const Top equations(1.001 * g);
  const auto error = [&](std::size_t n) {
    double difference = 0, size = 0, rates = 0, greatest = 0;
    const States exact = every(to, n);
    std::size_t i = 0;
    solve::deviation(*equations.system, 0, every(from, n),
                     [&](const solve::State& at, const VectorXd& d, const VectorXd& rate, const VectorXd&) {
                       const solve::State& there = exact[i++];
                       const Vector3d gap = math::rotation_vector(at.bases[0].conjugate() * there.bases[0]);
                       difference += (d.segment<3>(3) - gap).squaredNorm(), size += gap.squaredNorm();
                       const solve::State now =
                           solve::deviated(*equations.system, at, d, rate, VectorXd::Zero(d.size()));
                       const Vector3d w = there.v.segment<3>(3) - at.v.segment<3>(3);
                       rates += (now.v.segment<3>(3) - at.v.segment<3>(3) - w).squaredNorm();
                       greatest += w.squaredNorm();
                     });
    CHECK(i == exact.size());
    CHECK(std::sqrt(rates / greatest) < 0.1);
    return std::sqrt(difference / size);
  };
  const double coarse = error(16), fine = error(8);
  CHECK(fine < 0.001);
  CHECK(std::log2(coarse / fine) > 1.5);
}

TEST_CASE("deviation: nothing is missing, nothing deviates; what does not converge ends it") {
  const dynamics::System whole = testing::pendulum(m, l, g);
  const States from = states_of(whole, whole.create_vector(), whole.create_vector(), {0.5, 1e-3, 0.8, {}});
  solve::deviation(whole, 0, from, [&](const solve::State&, const VectorXd& d, const VectorXd&, const VectorXd&) {
    CHECK(d.head<3>().norm() < 1e-8);
  });
  States broken = from;
  broken[99].a[2] = NAN;
  const auto report = solve::deviation(whole, 0, broken, [](const auto&, const auto&, const auto&, const auto&) {});
  CHECK(report.steps == 99);
  CHECK(report.end == Approx(0.099));
}
