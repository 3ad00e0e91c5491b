#include <catch2/catch.hpp>
#include <cmath>

#include "random.h"
#include "spatial_systems.h"

using namespace floe;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;
using testing::numbers_of;
using testing::Random;
using testing::vector_of;

namespace {

const double m = 2;
const Vector3d moments(1, 1.6, 2.2);

struct FreeBody {
  std::shared_ptr<dynamics::Attitude> attitude = std::make_shared<dynamics::Attitude>();
  const dynamics::SpatialBody* body = nullptr;
  std::unique_ptr<dynamics::System> system;

  FreeBody(body::SpatialInertia inertia, body::Elasticity elasticity) {
    const int size = 6 + inertia.coordinates();
    dynamics::Coordinates coordinates(PETSC_COMM_SELF);
    coordinates.add_shared(size);
    coordinates.number();
    std::vector<int> all(size);
    for (int i = 0; i < size; ++i) all[i] = i;
    testing::Terms terms;
    terms.push_back(std::make_unique<dynamics::SpatialBody>(all, attitude, std::move(inertia), std::move(elasticity)));
    body = static_cast<const dynamics::SpatialBody*>(terms.front().get());
    system = std::make_unique<dynamics::System>(coordinates, std::move(terms), dynamics::Attitudes{{3, attitude}});
  }
  Matrix3d axes(const VectorXd& q) const { return attitude->axes(q.segment<3>(3)); }
};

/// A top that tumbles through its intermediate axis while its centre drifts.
const testing::Rotating start{moments, Vector3d::Zero(), math::quaternion({0.3, -0.8, 0.5}), {0.1, 2, -0.05}};
const double horizon = 8;

struct Error {
  double attitude, w, place;
  solve::IntegrationReport report;
};

Error tumble(const solve::Integration& how) {
  FreeBody free(testing::rigid(m, moments), testing::no_elasticity());
  free.attitude->base = start.attitude;
  const petsc::VecHandle U = free.system->create_vector(),
                         V = vector_of(*free.system, {1, 2, 3, start.w[0], start.w[1], start.w[2]});
  Error error{};
  error.report = solve::simulate(*free.system, how, U, V, [](const solve::Instant&) {});
  const testing::Rotating exact = start.after(horizon);
  const VectorXd q = numbers_of(U), v = numbers_of(V);
  error.attitude = (free.axes(q) - exact.attitude.toRotationMatrix()).norm();
  error.w = (v.tail<3>() - exact.w).norm();
  error.place = (q.head<3>() - horizon * Vector3d(1, 2, 3)).norm();
  return error;
}

}  // namespace

TEST_CASE("Euler's top tumbles through its intermediate axis: attitude and spin of order 2 against Runge-Kutta") {
  const testing::Rotating exact = start.after(horizon);  // the reference keeps momentum in world axes and energy
  const Matrix3d J = moments.asDiagonal();
  CHECK((exact.attitude * (J * exact.w) - start.attitude * (J * start.w)).norm() < 1e-11);
  CHECK(exact.w.dot(J * exact.w) == Approx(start.w.dot(J * start.w)).epsilon(1e-12));
  const Error coarse = tumble({horizon, 0.02, 0.8, {}}), fine = tumble({horizon, 0.01, 0.8, {}});
  INFO(coarse.attitude << " " << fine.attitude << ", " << coarse.w << " " << fine.w);
  CHECK(fine.attitude < 3e-2);
  CHECK(std::log2(coarse.attitude / fine.attitude) == Approx(2).margin(0.05));
  CHECK(std::log2(coarse.w / fine.w) == Approx(2).margin(0.05));
  CHECK(fine.place < 1e-12);
  CHECK(fine.report.newton <= 4 * fine.report.steps);
}

TEST_CASE("adaptive steps follow the tolerance on Euler's top") {
  const Error loose = tumble({horizon, 1e-2, 0.8, 1e-4}), tight = tumble({horizon, 1e-2, 0.8, 1e-7}),
              far_too_long = tumble({horizon, 2, 0.8, 1e-5});
  INFO(loose.attitude << " " << tight.attitude << " " << loose.report.steps << " " << tight.report.steps << " "
                      << far_too_long.attitude << " " << far_too_long.report.rejected);
  CHECK(loose.attitude / tight.attitude == Approx(100).epsilon(0.5));  // error ~ rtol^(2/3), steps ~ rtol^(-1/3)
  CHECK(double(tight.report.steps) / double(loose.report.steps) == Approx(10).epsilon(0.3));
  CHECK(far_too_long.report.rejected > 0);  // and tried again from the same attitude
  CHECK(far_too_long.attitude < 0.1);
}

TEST_CASE("a thousand revolutions about a principal axis: the attitude has no drift but round-off") {
  FreeBody free(testing::rigid(m, moments), testing::no_elasticity());
  free.attitude->base = start.attitude;
  const double w = 2 * M_PI;
  const petsc::VecHandle U = free.system->create_vector(), V = vector_of(*free.system, {0, 0, 0, 0, w, 0});
  double norm = 0;
  solve::simulate(*free.system, {1000, 0.05, 0.8, {}}, U, V,
                  [&](const solve::Instant&) { norm = std::max(norm, std::abs(free.attitude->base.norm() - 1)); });
  CHECK(norm < 1e-15);
  CHECK(numbers_of(U).segment<3>(3).norm() < 0.4);  // one step's rotation
  CHECK((free.axes(numbers_of(U)) - start.attitude.toRotationMatrix()).norm() < 1e-11 * 1000 * w);
  CHECK(numbers_of(V)[4] == Approx(w).epsilon(1e-12));
}

TEST_CASE("a free flexible body keeps momentum, moment of momentum and energy to order 2") {
  constexpr int k = 4;
  Random random(141);
  body::Inertia sum(3, k);
  for (int i = 0; i < 12; ++i) sum.add({1.5 + random.number(), random.vector(3), 0.4 * random.matrix(3, k)});
  const Eigen::MatrixXd root = 4 * random.matrix(k, k);
  const body::Elasticity elasticity{root.transpose() * root, Eigen::MatrixXd(0, k), {}};
  const VectorXd q0 = 0.1 * random.vector(k + 6), v0 = random.vector(k + 6);
  struct Drift {
    double linear = 0, angular = 0, energy = 0, bending = 0;
    VectorXd end;
  };
  const auto run = [&](double step) {
    FreeBody free(body::spatial(sum), elasticity);
    const petsc::VecHandle U = vector_of(*free.system, {q0.data(), q0.data() + q0.size()}),
                           V = vector_of(*free.system, {v0.data(), v0.data() + v0.size()});
    Drift drift;
    std::optional<body::Momentum> first;
    double energy = 0;
    solve::simulate(*free.system, {5, step, 0.9, {}}, U, V, [&](const solve::Instant& now) {
      const VectorXd q = numbers_of(now.U), v = numbers_of(now.V);
      const body::Momentum momentum = free.body->momentum({now.t, q, v, v});
      const dynamics::Energy parts = free.system->energy(now.t, now.U, now.V);
      if (!first) first = momentum, energy = parts.kinetic + parts.elastic;
      drift.linear = std::max(drift.linear, (momentum.linear - first->linear).norm());
      drift.angular = std::max(drift.angular, (momentum.angular - first->angular).norm());
      drift.energy = std::max(drift.energy, std::abs(parts.kinetic + parts.elastic - energy));
      drift.bending = std::max(drift.bending, parts.elastic / energy);
    });
    return drift;
  };
  const Drift coarse = run(0.004), fine = run(0.002);
  INFO(coarse.linear << " " << fine.linear << ", " << coarse.angular << " " << fine.angular << ", " << coarse.energy
                     << " " << fine.energy << ", " << fine.bending);
  CHECK(fine.bending > 0.05);  // it does deform
  CHECK(fine.linear < 1e-2);
  CHECK(std::log2(coarse.linear / fine.linear) == Approx(2).margin(0.15));
  CHECK(std::log2(coarse.angular / fine.angular) == Approx(2).margin(0.15));
  CHECK(std::log2(coarse.energy / fine.energy) == Approx(2).margin(0.3));
}

TEST_CASE("rotations are refused by a TS type that would add them as vectors") {
  FreeBody free(testing::rigid(m, moments), testing::no_elasticity());
  const petsc::VecHandle U = free.system->create_vector(), V = free.system->create_vector();
  petsc::check(PetscOptionsSetValue(nullptr, "-motion_ts_type", TSALPHA2));
  const auto run = [&] { solve::simulate(*free.system, {1, 0.1, 0.8, {}}, U, V, [](const solve::Instant&) {}); };
  CHECK_THROWS_AS(run(), InputError);
  CHECK_THROWS_WITH(run(), Catch::Contains("-motion_ts_type alpha2") && Catch::Contains("expected generalized-alpha"));
  petsc::check(PetscOptionsClearValue(nullptr, "-motion_ts_type"));
}
