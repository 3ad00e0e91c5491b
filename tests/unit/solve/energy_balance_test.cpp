#include "floe/solve/energy_balance.h"

#include <catch2/catch.hpp>

#include "floe/dynamics/damping.h"
#include "floe/solve/simulation.h"
#include "random.h"
#include "spatial_systems.h"

using namespace floe;
using testing::numbers_of;
using testing::vector_of;

namespace {

double total(const dynamics::Energy& energy) { return energy.kinetic + energy.elastic + energy.potential; }

solve::EnergyBalance balance_of(const dynamics::System& system, Vec U, Vec V, double end, double step) {
  solve::EnergyBalance balance;
  solve::simulate(system, {end, step, 0.8, {}}, U, V, [&](const solve::Instant& now) {
    const double energy = total(system.energy(now.t, now.U, now.V));
    balance.add(system, now.t, now.U, now.V, now.A, energy, std::abs(energy));
  });
  return balance;
}

/// A force across the end of a rod of length l, which follows it.
testing::Terms across_rod(double l, double force) {
  testing::Terms load;
  load.push_back(std::make_unique<dynamics::Force>(
      testing::on_rod(l),
      [force](double) -> Eigen::Vector3d {
        return {0, force, 0};
      },
      dynamics::Force::Axes::body));
  return load;
}

}  // namespace

// A force F across a hinged rod that follows it does the work F l per angle; gravity and the hinge do none.
TEST_CASE("the work of a follower force on a pendulum is its moment times the angle") {
  const double m = 2, l = 1.5, g = 9.81, F = 7;
  const dynamics::System system = testing::pendulum(m, l, g, across_rod(l, F));
  const petsc::VecHandle U = vector_of(system, {0, 0, -1, 0, 0}), V = system.create_vector();
  const solve::EnergyBalance balance = balance_of(system, U, V, 2, 1e-3);
  const double angle = numbers_of(U)[2] + 1;
  REQUIRE(std::abs(angle) > 0.1);
  CHECK(balance.work() == Approx(F * l * angle).margin(1e-5 * F * l));
  CHECK(balance.turnover() > std::abs(balance.work()));
  CHECK(balance.growth() < 1e-5 * F * l);
}

// The top's weight has no energy of its own here: its work is what its centre falls. Its frame rotates in every step.
TEST_CASE("the work of a force on a body in space, whose frame turns, is force times path") {
  const auto attitude = std::make_shared<dynamics::Attitude>();
  dynamics::Coordinates coordinates(PETSC_COMM_SELF);
  coordinates.add_shared(6);
  coordinates.add_shared(3, true);
  coordinates.number();
  testing::Terms terms;
  const double weight = 20;
  terms.push_back(std::make_unique<dynamics::SpatialBody>(std::vector<int>{0, 1, 2, 3, 4, 5}, attitude,
                                                          testing::rigid(2, {1, 1.6, 2.2}), testing::no_elasticity()));
  terms.push_back(std::make_unique<testing::HeavyOnPoint>(attitude, Eigen::Vector3d(0.5, 0, 0.3), weight));
  const dynamics::System system(std::move(coordinates), std::move(terms), {{3, attitude}});
  const petsc::VecHandle U = vector_of(system, {-0.5, 0, -0.3, 0, 0, 0, 0, 0, 0});
  const petsc::VecHandle V = vector_of(system, {-0.9, 1.8, 1.5, 1, 3, -3, 0, 0, 0});
  const double start = total(system.energy(0, U, V));
  const solve::EnergyBalance balance = balance_of(system, U, V, 1.5, 1e-3);
  const double work = -weight * (numbers_of(U)[2] + 0.3);
  REQUIRE(std::abs(work) > 1);
  CHECK(balance.work() == Approx(work).epsilon(1e-4));
  CHECK(total(system.energy(1.5, U, V)) - start == Approx(work).epsilon(1e-4));
}

TEST_CASE("energy that grows without work is seen, also by a balance that was saved and loaded") {
  const dynamics::System system = testing::pendulum(2, 1.5, 9.81);
  solve::EnergyBalance balance;
  const double J = 2 * 1.5 * 1.5 / 3;
  for (int i = 0; i <= 10; ++i) {
    // swings that grow, with the accelerations of none: w = w0 (1 + 3 t)
    const double t = 0.1 * i, w = 1 + 3 * t;
    const petsc::VecHandle U = vector_of(system, {0, 0, -M_PI / 2, 0, 2 * (9.81 + 0.75 * w * w)}),
                           V = vector_of(system, {0, 0, w, 0, 0}), A = vector_of(system, {0, 0, 0, 0, 0});
    balance.add(system, t, U, V, A, total(system.energy(t, U, V)), 0.5 * J * w * w);
    solve::EnergyBalance other;
    other.load(balance.save());
    balance = other;
    // accounted for until J w^2 / 2 of w = 1.3; growth J (w^2 - 1) / 2 of three times that from w = 2.5 on, i = 5
    CHECK(balance.runs_away(0) == (i >= 6));
    CHECK(!balance.runs_away(10 * J));
  }
  CHECK(balance.work() == Approx(0).margin(1e-6));
  CHECK(balance.growth() == Approx(0.5 * J * (16 - 1)).epsilon(1e-6));
}

// A damper of -3 J and an energy that falls by 1 J at each instant: samples overestimate the dissipation.
TEST_CASE("dissipation that samples overestimate is no growth of energy, and rises since an event are") {
  testing::Terms damper;
  damper.push_back(std::make_unique<dynamics::LinearDamping>(std::vector<int>{2}, Eigen::MatrixXd::Constant(1, 1, 30)));
  const dynamics::System system = testing::pendulum(2, 1.5, 0, std::move(damper));
  const petsc::VecHandle U = system.create_vector(), V = vector_of(system, {0, 0, -1, 0, 0}),  // -30 W
      A = system.create_vector();
  solve::EnergyBalance balance;
  balance.add(system, 0, U, V, A, 20, 20);
  balance.pass_event(0, 0);
  solve::EnergyBalance from_start;
  from_start.add(system, 0, U, V, A, 20, 20);
  for (int i = 1; i <= 10; ++i) {
    balance.add(system, 0.1 * i, U, V, A, 20 - i, 20);
    from_start.add(system, 0.1 * i, U, V, A, 20 - i, 20);
    CHECK(!from_start.runs_away(0));
  }
  CHECK(from_start.growth() == 0);
  CHECK(balance.work() == Approx(-10));  // not more than is lost
  CHECK(balance.growth() == 0);
  balance.add(system, 1.1, U, V, A, 15, 20);
  CHECK(balance.growth() == Approx(5));
  balance.pass_event(0, 0);  // rises count from its energy on, 15 J
  balance.add(system, 1.2, U, V, A, 22, 22);
  CHECK(balance.growth() == Approx(7));
  balance.pass_event(4, 0), balance.pass_event(3, 0);  // what drives bring at one instant is no growth
  balance.add(system, 1.3, U, V, A, 29, 29);
  CHECK(balance.growth() == Approx(7));
  balance.add(system, 1.4, U, V, A, 37, 37);
  CHECK(balance.growth() == Approx(8));
}

// Of 10 J a joint takes 4 J at an event; the damper, of which samples see 30 J, has no more than the other 6 J.
TEST_CASE("what impulses of joints take is not dissipated by dampers") {
  testing::Terms damper;
  damper.push_back(std::make_unique<dynamics::LinearDamping>(std::vector<int>{2}, Eigen::MatrixXd::Constant(1, 1, 30)));
  const dynamics::System system = testing::pendulum(2, 1.5, 0, std::move(damper));
  const petsc::VecHandle U = system.create_vector(), V = vector_of(system, {0, 0, -1, 0, 0}),
                         A = system.create_vector();
  solve::EnergyBalance balance;
  balance.add(system, 0, U, V, A, 10, 10);
  balance.add(system, 0.5, U, V, A, 7, 10);
  CHECK(balance.work() == Approx(-3));
  balance.pass_event(0, 4);
  solve::EnergyBalance continued;
  continued.load(balance.save());
  continued.add(system, 1, U, V, A, 0, 10);
  CHECK(continued.work() == Approx(-6));
  CHECK(continued.growth() == 0);
}

// A load 30 N m s/rad times the rate, along it: 30 W, and the energy rises by as much.
TEST_CASE("what loads along the velocity feed in is work, and no growth of energy") {
  testing::Terms driven;
  driven.push_back(
      std::make_unique<dynamics::LinearDamping>(std::vector<int>{2}, Eigen::MatrixXd::Constant(1, 1, -30)));
  const dynamics::System system = testing::pendulum(2, 1.5, 0, std::move(driven));
  const petsc::VecHandle U = system.create_vector(), V = vector_of(system, {0, 0, -1, 0, 0}),
                         A = system.create_vector();
  solve::EnergyBalance balance;
  balance.add(system, 0, U, V, A, 0.1, 0.1);
  for (int i = 1; i <= 10; ++i) {
    balance.add(system, 0.1 * i, U, V, A, 0.1 + 3 * i, 0.1 + 3 * i);
    CHECK(!balance.runs_away(0));
  }
  CHECK(balance.work() == Approx(30));
  CHECK(balance.growth() == Approx(0).margin(1e-9));
}
