#include "floe/solve/start.h"

#include <catch2/catch.hpp>
#include <limits>

#include "systems.h"
#include "terms.h"

using namespace floe;
using dynamics::ConstraintLevel;
using Eigen::VectorXd;
using testing::numbers_of;
using testing::vector_of;

namespace {

const double m = 2, l = 1.5, g = 9.81;

}  // namespace

TEST_CASE("consistent start of a compound pendulum: its accelerations and the forces of its hinge") {
  const dynamics::System system = testing::pendulum(m, l, g);
  const double theta = 0.4, w = 1.3;
  const petsc::VecHandle U = vector_of(system, {0, 0, theta, 99, 99}), V = vector_of(system, {0, 0, w, 0, 0}),
                         A = vector_of(system, {9, 9, 9, 9, 9}), F = system.create_vector();
  solve::consistent_start(system, 0, U, V, A);
  const VectorXd u = numbers_of(U), a = numbers_of(A);
  const double alpha = -1.5 * g / l * std::cos(theta), half = l / 2;
  CHECK(a[2] == Approx(alpha).epsilon(1e-12));
  CHECK(std::abs(a[0]) + std::abs(a[1]) < 1e-12);
  CHECK((a[3] == 0 && a[4] == 0));
  CHECK(u[2] == theta);
  // r_R = inertia + weight + lambda = 0: lambda = -(mass x acceleration of the centre) - weight
  const double c = std::cos(theta), s = std::sin(theta);
  CHECK(u[3] == Approx(m * half * (alpha * s + w * w * c)).epsilon(1e-12));
  CHECK(u[4] == Approx(-m * half * (alpha * c - w * w * s) - m * g).epsilon(1e-12));
  system.residual(0, U, V, A, ConstraintLevel::acceleration, F);
  CHECK(numbers_of(F).cwiseAbs().maxCoeff() < 1e-11);
}

TEST_CASE("consistent start with a driven joint: the drive's acceleration is met") {
  const dynamics::TimeFunction drive{[](double t) { return 0.5 * t * t; }, [](double t) { return t; },
                                     [](double) { return 1.; }};
  dynamics::Coordinates c(PETSC_COMM_SELF);
  c.add_shared(3);
  c.add_shared(3, true);
  c.number();
  testing::Terms terms;
  terms.push_back(testing::rigid_rod(m, l));
  terms.push_back(testing::to_ground(testing::on_rod(0), dynamics::Clamp{0, drive}));
  const dynamics::System system(c, std::move(terms));
  const petsc::VecHandle U = system.create_vector(), V = system.create_vector(), A = system.create_vector();
  solve::consistent_start(system, 0, U, V, A);
  CHECK(numbers_of(A)[2] == Approx(1).epsilon(1e-13));
  CHECK(numbers_of(U)[5] == Approx(-m * l * l / 3).epsilon(1e-12));
}

TEST_CASE("joints that hold the same motion twice, and mass that is missing, are run errors") {
  testing::Terms twice;
  dynamics::Coordinates c(PETSC_COMM_SELF);
  c.belongs_to("body rod");
  c.add_shared(3);
  c.belongs_to("joint hinge");
  c.add_shared(2, true);
  c.belongs_to("joint clamp");
  c.add_shared(3, true);
  c.number();
  twice.push_back(testing::rigid_rod(m, l));
  twice.push_back(testing::weight(m, l, g));
  twice.push_back(testing::to_ground(testing::on_rod(0), dynamics::Revolute{}, 3));
  twice.push_back(testing::to_ground(testing::on_rod(0), dynamics::Clamp{}, 5));
  const dynamics::System repeated(c, std::move(twice)), massless = testing::pendulum(0, 0, g);
  for (const dynamics::System* system : {&repeated, &massless}) {
    const petsc::VecHandle U = system->create_vector(), V = system->create_vector(), A = system->create_vector();
    CHECK_THROWS_AS(solve::consistent_start(*system, 0, U, V, A), RunError);
  }
  const petsc::VecHandle U = repeated.create_vector(), V = repeated.create_vector(), A = repeated.create_vector();
  CHECK_THROWS_WITH(solve::consistent_start(repeated, 0, U, V, A), Catch::EndsWith(" (joint hinge, joint clamp)"));
}

TEST_CASE("consistent velocities: the nearest allowed ones in kinetic energy") {
  const dynamics::System system = testing::pendulum(m, l, g);
  const double theta = 0.4;
  const petsc::VecHandle U = vector_of(system, {0, 0, theta, 0, 0}), V = vector_of(system, {1, -2, 0.7, 0, 0});
  CHECK(solve::constraint_violation(system, 0, U, V, ConstraintLevel::velocity) == Approx(2));
  CHECK(solve::constraint_violation(system, 0, U, V, ConstraintLevel::position) == 0);
  const double change = solve::consistent_velocities(system, 0, U, V);
  CHECK(change > 0.1);
  CHECK(solve::constraint_violation(system, 0, U, V, ConstraintLevel::velocity) < 1e-13);
  // the moment of momentum about the hinge is kept: C0 w + s0 x v before = C0 w' after
  const double before = m * l * l / 3 * 0.7 + m * l / 2 * (std::cos(theta) * -2 - std::sin(theta) * 1);
  CHECK(numbers_of(V)[2] == Approx(before / (m * l * l / 3)).epsilon(1e-12));
  CHECK(solve::consistent_velocities(system, 0, U, V) < 1e-14);  // nothing left to do
}

TEST_CASE("consistent velocities where numerical damping has left denormal ones") {
  dynamics::Coordinates c(PETSC_COMM_SELF);
  c.add_shared(3);
  c.add_shared(3, true);
  c.number();
  testing::Terms terms;
  terms.push_back(testing::rigid_rod(m, l));
  terms.push_back(testing::to_ground(testing::on_rod(l), dynamics::Clamp{}));
  const dynamics::System system(c, std::move(terms));
  for (int digits = 1; digits < 60; ++digits) {
    const double v = digits * std::numeric_limits<double>::denorm_min();
    const petsc::VecHandle U = vector_of(system, {0, 0, 0.4, 0, 0, 0}), V = vector_of(system, {v, -2 * v, v, 0, 0, 0});
    CHECK_NOTHROW(solve::consistent_velocities(system, 0, U, V));
    CHECK(numbers_of(V).cwiseAbs().maxCoeff() < 1e-300);
  }
}

TEST_CASE("equilibrium: a rod on a torsional hinge under its weight") {
  const double stiffness = 20;
  testing::Terms spring;
  spring.push_back(std::make_unique<dynamics::Spring>(dynamics::Marker::ground({0, 0}), testing::on_rod(0),
                                                      dynamics::SpringProperties{0, 0, 0, stiffness, 0, 0}));
  const dynamics::System system = testing::pendulum(m, l, g, std::move(spring));
  const petsc::VecHandle U = vector_of(system, {0.1, 0.1, 0.2, 0, 0}), V = system.create_vector();
  solve::equilibrium(system, 0, U, V);
  const VectorXd u = numbers_of(U);
  CHECK(stiffness * u[2] == Approx(-m * g * l / 2 * std::cos(u[2])).epsilon(1e-11));
  CHECK(u[2] < -0.3);
  CHECK(u[4] == Approx(-m * g).epsilon(1e-11));
  CHECK(std::abs(u[0]) + std::abs(u[1]) < 1e-12);
}

TEST_CASE("equilibrium at a constant speed: a spring in a turning body stretches by w^2 h / (k - w^2 m)") {
  // one elastic coordinate along x of a mass 3 at (2, 0), constrained by a spring of 50, rotated at 1.7 rad/s
  body::Inertia sum(2, 1);
  sum.add({3, Eigen::Vector2d(2, 0), Eigen::Vector2d(1, 0)});
  const double w = 1.7, k = 50;
  const dynamics::TimeFunction drive{[w](double t) { return w * t; }, [w](double) { return w; },
                                     [](double) { return 0.; }};
  dynamics::Marker hub = testing::on_rod(0);
  hub.coordinates = {0, 1, 2, 3};
  hub.S = Eigen::Vector2d::Zero();
  hub.psi = Eigen::RowVectorXd::Zero(1);
  dynamics::Coordinates c(PETSC_COMM_SELF);
  c.add_shared(4);
  c.add_shared(3, true);
  c.number();
  testing::Terms terms;
  terms.push_back(std::make_unique<dynamics::FloatingBody>(
      std::vector<int>{0, 1, 2, 3}, body::planar(sum),
      body::Elasticity{Eigen::MatrixXd::Constant(1, 1, k), Eigen::MatrixXd(0, 1), {}}));
  terms.push_back(testing::to_ground(hub, dynamics::Clamp{0, drive}, 4));
  const dynamics::System system(c, std::move(terms));
  const petsc::VecHandle U = system.create_vector(), V = vector_of(system, {0, 0, w, 0, 0, 0, 0});
  solve::equilibrium(system, 0.9, U, V);
  CHECK(numbers_of(U)[3] == Approx(w * w * 6 / (k - w * w * 3)).epsilon(1e-11));
  CHECK(numbers_of(U)[2] == Approx(w * 0.9).epsilon(1e-12));
}

TEST_CASE("a pendulum hangs in a stable equilibrium and stands in an unstable one") {
  const dynamics::System system = testing::pendulum(m, l, g);
  for (const auto& [theta, directions] : {std::pair{-M_PI / 2 + 0.1, 0}, {M_PI / 2 - 0.1, 1}}) {
    const petsc::VecHandle U = vector_of(system, {0, 0, theta, 0, 0}), V = system.create_vector();
    solve::equilibrium(system, 0, U, V);
    CHECK(std::abs(numbers_of(U)[2]) == Approx(M_PI / 2).epsilon(1e-9));
    CHECK(solve::unstable_directions(system, 0, U, V) == directions);
  }
}

TEST_CASE("whether an equilibrium gives way is not said where a load follows the body") {
  testing::Terms push;  // along the rod: the weight still holds it
  push.push_back(std::make_unique<dynamics::Force>(
      testing::on_rod(l), [](double) { return Eigen::Vector3d(-1, 0.5, 0); }, dynamics::Force::Axes::body));
  const dynamics::System system = testing::pendulum(m, l, g, std::move(push));
  const petsc::VecHandle U = vector_of(system, {0, 0, -M_PI / 2 + 0.1, 0, 0}), V = system.create_vector();
  solve::equilibrium(system, 0, U, V);
  CHECK_FALSE(solve::unstable_directions(system, 0, U, V).has_value());
}

namespace {

/// A rod on a hinge, pushed at its end by a force in world axes.
dynamics::System pushed_rod(const Eigen::Vector3d& force, int hinges = 1) {
  testing::Terms terms;
  terms.push_back(std::make_unique<dynamics::Force>(
      testing::on_rod(l), [force](double) { return force; }, dynamics::Force::Axes::world));
  dynamics::Coordinates c(PETSC_COMM_SELF);
  c.belongs_to("body rod");
  c.add_shared(3);
  for (int i = 0; i < hinges; ++i) {
    c.belongs_to("joint hinge " + std::to_string(i + 1));
    c.add_shared(2, true);
  }
  c.number();
  terms.push_back(testing::rigid_rod(m, l));
  for (int i = 0; i < hinges; ++i)
    terms.push_back(testing::to_ground(testing::on_rod(0), dynamics::Revolute{}, 3 + 2 * i));
  return dynamics::System(c, std::move(terms));
}

}  // namespace

TEST_CASE("where nothing resists at the start but will, the equilibrium is found") {
  const dynamics::System system = pushed_rod({0, 3, 0});
  const petsc::VecHandle U = vector_of(system, {0, 0, 0, 0, 0}), V = system.create_vector();
  solve::equilibrium(system, 0.5, U, V);
  CHECK(std::abs(std::cos(numbers_of(U)[2])) < 1e-9);
  CHECK(solve::unstable_directions(system, 0.5, U, V) == 0);
}

TEST_CASE("where nothing resists at all, and where constraints repeat, the search says which, and of whom") {
  const dynamics::System loose = pushed_rod({0, 0, 0});
  const petsc::VecHandle U = loose.create_vector(), V = loose.create_vector();
  CHECK_THROWS_AS(solve::equilibrium(loose, 0.5, U, V), solve::Unconstrained);
  CHECK_THROWS_WITH(solve::equilibrium(loose, 0.5, U, V), Catch::Contains("singular tangent stiffness (body rod)"));
  const dynamics::System twice = pushed_rod({3, 0, 0}, 2);
  const petsc::VecHandle U2 = twice.create_vector(), V2 = twice.create_vector();
  CHECK_THROWS_WITH(solve::equilibrium(twice, 0.5, U2, V2),
                    Catch::Contains("redundant constraints (joint hinge 1, joint hinge 2)"));
}

TEST_CASE("no equilibrium is a run error that says when") {
  testing::Terms push;  // a moment that the weight cannot balance at any angle
  push.push_back(std::make_unique<dynamics::Force>(
      testing::on_rod(l), [](double) { return Eigen::Vector3d(0, 0, 1e3); }, dynamics::Force::Axes::world));
  const dynamics::System driven = testing::pendulum(m, l, g, std::move(push));
  const petsc::VecHandle U = driven.create_vector(), V = driven.create_vector();
  CHECK_THROWS_AS(solve::equilibrium(driven, 0.25, U, V), RunError);
}
