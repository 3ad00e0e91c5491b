#include "floe/dynamics/pressure_load.h"

#include <catch2/catch.hpp>

#include "spatial_terms.h"

using namespace floe;
using dynamics::PressureLoad;
using testing::Random;
using testing::State;

namespace {

body::Pressure random_pressure(Random& random, int k) {
  body::Pressure sum(k);
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector3d normal = random.vector(3).normalized();
    sum.add(0.3 + 0.1 * i, random.vector(3), normal, random.matrix(3, k), random.matrix(3, k));
  }
  return sum;
}

}  // namespace

TEST_CASE("tangents of pressures, follower and dead, are the differences of the residual along the chart") {
  Random random(251);
  for (const auto kind : {PressureLoad::Kind::follower, PressureLoad::Kind::dead})
    for (const bool moves : {true, false}) {
      std::vector<int> coordinates(moves ? 9 : 3);
      for (int i = 0; i < static_cast<int>(coordinates.size()); ++i) coordinates[i] = i;
      const PressureLoad load(
          coordinates, moves ? testing::attitude(random) : nullptr, random_pressure(random, 3),
          [](double t) { return 2 + t * t; }, kind, math::rotation(random.vector(3)));
      const State s(random, static_cast<Eigen::Index>(coordinates.size()));
      CHECK(testing::tangent_error(load, s) < 1e-8);
    }
}

TEST_CASE("a dead pressure and one that follows are the same load at the start") {
  Random random(252);
  const auto attitude = testing::attitude(random);
  const body::Pressure unit = random_pressure(random, 2);
  State s(random, 8);
  s.q.setZero();
  const auto load = [&](PressureLoad::Kind kind) {
    return PressureLoad(
        {0, 1, 2, 3, 4, 5, 6, 7}, attitude, unit, [](double) { return 1.5; }, kind,
        attitude->axes(Eigen::Vector3d::Zero()));
  };
  const Eigen::VectorXd follower = testing::rows_of(load(PressureLoad::Kind::follower), s),
                        dead = testing::rows_of(load(PressureLoad::Kind::dead), s);
  CHECK(follower.norm() > 0.1);
  CHECK((follower - dead).norm() < 1e-13);
}
