#include "floe/dynamics/joints.h"

#include <catch2/catch.hpp>

#include "terms.h"

using namespace floe;
using dynamics::ConstraintLevel;
using dynamics::Joint;
using Eigen::VectorXd;
using testing::Random;
using testing::State;

namespace {

constexpr int first_multiplier = 100;

dynamics::TimeFunction swing() {
  return {[](double t) { return 0.7 * std::sin(3 * t); }, [](double t) { return 2.1 * std::cos(3 * t); },
          [](double t) { return -6.3 * std::sin(3 * t); }};
}

std::vector<dynamics::Constraint> fixed() {
  return {dynamics::Revolute{}, dynamics::Clamp{0.3, {}}, dynamics::Prismatic{{0.6, 0.8}, 0.2, -0.4}};
}

std::vector<dynamics::Constraint> all() {
  auto constraints = fixed();
  constraints.push_back(dynamics::Clamp{0.3, swing()});
  return constraints;
}

/// Calls `test(joint, rows)` for every constraint between every pair of places.
template <class Test>
void each(const std::vector<dynamics::Constraint>& constraints, const Test& test) {
  for (const auto& constraint : constraints)
    for (const auto& [first, second] : testing::place_pairs()) {
      INFO("constraint " << constraint.index());
      test(Joint(first, second, constraint, first_multiplier), dynamics::rows(constraint));
    }
}

Eigen::Index size(const Joint& joint) { return static_cast<Eigen::Index>(joint.coordinates().size()); }

}  // namespace

TEST_CASE("a joint's coordinates are those of both places, each once, then its multipliers") {
  const auto pairs = testing::place_pairs();
  const Joint two_bodies(pairs[0].first, pairs[0].second, dynamics::Clamp{}, first_multiplier);
  CHECK(two_bodies.coordinates() == std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 100, 101, 102});
  const Joint one_body(pairs[1].first, pairs[1].second, dynamics::Revolute{}, first_multiplier);
  CHECK(one_body.coordinates() == std::vector<int>{0, 1, 2, 3, 4, 100, 101});
  const Joint ground(pairs[3].first, pairs[3].second, dynamics::Prismatic{}, first_multiplier);
  CHECK(ground.coordinates() == std::vector<int>{0, 1, 2, 3, 4, 100, 101});
}

TEST_CASE("joint tangents in q, v and a are the differences of the residual") {
  Random random(91);
  each(all(), [&](const Joint& joint, int rows) {
    for (int i = 0; i < 2; ++i) CHECK(testing::tangent_error(joint, State(random, size(joint)), rows) < 1e-9);
  });
}

TEST_CASE("velocity and acceleration levels are the time derivatives of the position level") {
  Random random(92);
  each(all(), [&](const Joint& joint, int rows) {
    const testing::SmoothMotion motion(random, size(joint));
    const auto level = [&](ConstraintLevel at, double t) {
      State s(random, 0);
      s.q = motion.q(t), s.v = motion.v(t), s.a = motion.a(t), s.t = t;
      return VectorXd(testing::rows_of(joint, s, at).tail(rows));
    };
    const double t = 0.6;
    const auto position = [&](double s) { return level(ConstraintLevel::position, s); };
    const auto velocity = [&](double s) { return level(ConstraintLevel::velocity, s); };
    CHECK((level(ConstraintLevel::velocity, t) - testing::derivative(position, t, 1e-3)).norm() < 1e-9);
    CHECK((level(ConstraintLevel::acceleration, t) - testing::derivative(velocity, t, 1e-3)).norm() < 1e-9);
  });
}

TEST_CASE("joints do no work: the power of their forces is lambda times the rate of the constraint") {
  Random random(93);
  each(fixed(), [&](const Joint& joint, int rows) {
    State s(random, size(joint));
    const Eigen::Index n = size(joint) - rows;
    const VectorXd lambda = s.q.tail(rows);
    const VectorXd rate = testing::rows_of(joint, s, ConstraintLevel::velocity).tail(rows);
    const VectorXd force = testing::rows_of(joint, s).head(n);
    CHECK(force.norm() > 0.1);
    CHECK(force.dot(s.v.head(n)) == Approx(lambda.dot(rate)).epsilon(1e-12).margin(1e-13));
    // nothing at velocities that the joint allows
    const Eigen::MatrixXd C = testing::tangent_of(joint, s, {0, 0, 0}).bottomLeftCorner(rows, n);
    const VectorXd allowed = s.v.head(n) - C.completeOrthogonalDecomposition().solve(C * s.v.head(n));
    s.v.head(n) = allowed;
    CHECK(testing::rows_of(joint, s, ConstraintLevel::velocity).tail(rows).norm() < 1e-12);
    CHECK(std::abs(force.dot(allowed)) < 1e-12);
  });
}

TEST_CASE("the forces of a joint do not depend on the level of its constraint rows") {
  Random random(94);
  each(all(), [&](const Joint& joint, int rows) {
    const State s(random, size(joint));
    const VectorXd position = testing::rows_of(joint, s),
                   acceleration = testing::rows_of(joint, s, ConstraintLevel::acceleration);
    CHECK(position.head(size(joint) - rows) == acceleration.head(size(joint) - rows));
  });
}

TEST_CASE("what each joint holds, in plain numbers") {
  // a body at (1, 2) rotated by 90 degrees, its place 0.5 ahead of the origin: at (1, 2.5)
  dynamics::Marker place;
  place.framed = true;
  place.coordinates = {0, 1, 2};
  place.x << 0.5, 0;
  place.S.resize(2, 0);
  place.psi.resize(0);
  const dynamics::Marker ground = dynamics::Marker::ground({3, 4}, 0.1);
  const double right = std::acos(0.);
  const auto C = [&](const dynamics::Constraint& constraint) {
    const Joint joint(ground, place, constraint, 3);
    Random random;
    State s(random, 3 + dynamics::rows(constraint));
    s.q.setZero();
    s.q.head<3>() << 1, 2, right;
    s.t = 0.5;
    return VectorXd(testing::rows_of(joint, s).tail(dynamics::rows(constraint)));
  };
  CHECK((C(dynamics::Revolute{}) - Eigen::Vector2d(-2, -1.5)).norm() < 1e-14);
  CHECK((C(dynamics::Clamp{0.2, {}}) - Eigen::Vector3d(-2, -1.5, right - 0.1 - 0.2)).norm() < 1e-14);
  CHECK((C(dynamics::Clamp{0.2, swing()}) - Eigen::Vector3d(-2, -1.5, right - 0.3 - 0.7 * std::sin(1.5))).norm() <
        1e-14);
  const Eigen::Vector2d n(std::cos(0.1), std::sin(0.1));  // (1, 0) rotated with the first place
  CHECK((C(dynamics::Prismatic{{1, 0}, 0.25, 0.05}) -
         Eigen::Vector2d(n.dot(Eigen::Vector2d(-2, -1.5)) - 0.25, right - 0.15))
            .norm() < 1e-14);
}

// A rigid body at (x, y, a) on the ground: rows that were left out are watched within a thousandth of the extent, 20 m,
// and of a radian.
TEST_CASE("a joint whose rows were left out is violated where these are not met") {
  using dynamics::ConstraintStatus;
  dynamics::Marker place;
  place.framed = true;
  place.coordinates = {0, 1, 2};
  place.S.resize(2, 0);
  place.psi.resize(0);
  const auto status = [&](const dynamics::Constraint& constraint, std::vector<int> rows, const Eigen::Vector3d& pose) {
    Joint joint(dynamics::Marker::ground({0, 0}), place, constraint, 3, rows);
    joint.extent = 20;
    VectorXd q = VectorXd::Zero(size(joint));
    q.head<3>() = pose;
    const VectorXd none = VectorXd::Zero(q.size());
    return joint.constraint_status({0, q, none, none});
  };
  CHECK(status(dynamics::Revolute{}, {0}, {5, 0.019, 1}) == ConstraintStatus::satisfied);  // row 0 is an equation
  CHECK(status(dynamics::Revolute{}, {0}, {0, 0.021, 1}) == ConstraintStatus::violated);
  CHECK(status(dynamics::Revolute{}, {0, 1}, {5, 5, 1}) == ConstraintStatus::satisfied);
  CHECK(status(dynamics::Clamp{}, {0, 1}, {0, 0, 9e-4}) == ConstraintStatus::satisfied);
  CHECK(status(dynamics::Clamp{}, {0, 1}, {0, 0, 1.1e-3}) == ConstraintStatus::violated);
  CHECK(status(dynamics::Prismatic{}, {}, {7, 0.019, 0}) == ConstraintStatus::satisfied);
  CHECK(status(dynamics::Prismatic{}, {}, {7, 0, 1.1e-3}) == ConstraintStatus::violated);
}
