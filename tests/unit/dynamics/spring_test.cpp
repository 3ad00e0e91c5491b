#include <catch2/catch.hpp>

#include "floe/dynamics/joints.h"
#include "terms.h"

using namespace floe;
using dynamics::Spring;
using Eigen::VectorXd;
using testing::Random;
using testing::State;

namespace {

const dynamics::SpringProperties damped{3, 0.7, 0.4, 2, 0.3, -0.2}, undamped{3, 0, 0.4, 2, 0, -0.2};

template <class Test>
void each(const dynamics::SpringProperties& properties, const Test& test) {
  for (const auto& [first, second] : testing::place_pairs()) test(Spring(first, second, properties));
}

Eigen::Index size(const Spring& spring) { return static_cast<Eigen::Index>(spring.coordinates().size()); }

double elastic(const Spring& spring, const State& s) { return spring.energy({s.t, s.q, s.v, s.a}).elastic; }

}  // namespace

TEST_CASE("spring tangents in q, v and a are the differences of the force, damping included") {
  Random random(101);
  each(damped, [&](const Spring& spring) {
    for (int i = 0; i < 2; ++i) CHECK(testing::tangent_error(spring, State(random, size(spring))) < 1e-7);
  });
}

TEST_CASE("the force of an undamped spring is the gradient of its energy") {
  Random random(102);
  each(undamped, [&](const Spring& spring) {
    State s(random, size(spring));
    const auto energy = [&](const VectorXd& q) {
      State moved = s;
      moved.q = q;
      return elastic(spring, moved);
    };
    CHECK(testing::relative_error(testing::rows_of(spring, s), testing::gradient(energy, s.q, 1e-3)) < 1e-9);
  });
}

TEST_CASE("a damper takes power out of the motion, with the square of the speed") {
  Random random(103);
  each(damped, [&](const Spring& spring) {
    const State s(random, size(spring));
    const auto spent = [&](double speed) {
      State moving = s;
      moving.v *= speed;
      const auto stored = [&](double t) {
        State later = moving;
        later.q += t * moving.v;
        return elastic(spring, later);
      };
      return testing::rows_of(spring, moving).dot(moving.v) - testing::derivative(stored, 0, 1e-3);
    };
    CHECK(spent(1) > 0);
    CHECK(spent(0.5) == Approx(spent(1) / 4).epsilon(1e-7));
  });
}

TEST_CASE("a spring between two points of the line: Hooke and Newton") {
  // a point at (4, 3) that moves with (1, 2), constrained to the origin: length 5, lengthening 2
  dynamics::Marker point;
  point.coordinates = {0, 1, 2};
  point.S = Eigen::Matrix<double, 2, 3>::Identity();
  point.psi = Eigen::RowVector3d(0, 0, 1);
  const Spring spring(dynamics::Marker::ground({0, 0}, 0.5), point, damped);
  Random random;
  State s(random, 3);
  s.q << 4, 3, 0.9;
  s.v << 1, 2, 0.6;
  const double f = 3 * (5 - 0.4) + 0.7 * 2, m = 2 * (0.4 + 0.2) + 0.3 * 0.6;
  CHECK((testing::rows_of(spring, s) - Eigen::Vector3d(0.8 * f, 0.6 * f, m)).norm() < 1e-13);
  CHECK(elastic(spring, s) == Approx(0.5 * 3 * 4.6 * 4.6 + 0.5 * 2 * 0.36).epsilon(1e-14));
}

TEST_CASE("places that coincide have no line of action: torsion alone, and finite numbers") {
  dynamics::Marker point;
  point.coordinates = {0, 1, 2};
  point.S = Eigen::Matrix<double, 2, 3>::Identity();
  point.psi = Eigen::RowVector3d(0, 0, 1);
  const Spring spring(dynamics::Marker::ground({0, 0}), point, damped);
  Random random;
  State s(random, 3);
  s.q.head<2>().setZero();
  const VectorXd r = testing::rows_of(spring, s);
  CHECK(r.head<2>().norm() == 0);
  CHECK(r[2] == Approx(2 * (s.q[2] + 0.2) + 0.3 * s.v[2]).epsilon(1e-14));
  CHECK(testing::tangent_of(spring, s, {1, 1, 1}).allFinite());
}
