#include "floe/dynamics/spatial_joint.h"

#include <catch2/catch.hpp>

#include "floe/dynamics/joints.h"
#include "floe/error.h"
#include "spatial_terms.h"

using namespace floe;
using dynamics::ConstraintLevel;
using dynamics::SpatialConstraint;
using dynamics::SpatialJoint;
using dynamics::SpatialMarker;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using testing::Random;
using testing::State;

namespace {

constexpr int first_multiplier = 100;

dynamics::TimeFunction swing() {
  return {[](double t) { return 0.7 * std::sin(3 * t); }, [](double t) { return 2.1 * std::cos(3 * t); },
          [](double t) { return -6.3 * std::sin(3 * t); }};
}

std::vector<SpatialConstraint> still() {
  using C = SpatialConstraint;
  SpatialConstraint shifted{{dynamics::Along{0, 0.3}, dynamics::Along{2, -0.2}}};
  return {C::fixed(),     C::revolute(), C::prismatic(),   C::cylindrical(), C::spherical(),
          C::universal(), C::planar(),   C::distance(0.8), shifted};
}

std::vector<SpatialConstraint> all() {
  auto constraints = still();
  constraints.push_back(SpatialConstraint::driven_revolute(swing()));
  constraints.push_back(SpatialConstraint::driven_prismatic(swing()));
  return constraints;
}

/// Calls `test(joint, rows, places)` for every constraint between every pair of places.
template <class Test>
void each(const std::vector<SpatialConstraint>& constraints, const Test& test) {
  for (std::size_t i = 0; i < constraints.size(); ++i)
    for (const auto& places : testing::spatial_pairs()) {
      INFO("constraint " << i);
      test(SpatialJoint(places.first, places.second, constraints[i], first_multiplier), dynamics::rows(constraints[i]),
           places);
    }
}

Eigen::Index size(const SpatialJoint& joint) { return static_cast<Eigen::Index>(joint.coordinates().size()); }

}  // namespace

TEST_CASE("a spatial joint's coordinates are those of both places, each once, then a multiplier of each row") {
  const auto pairs = testing::spatial_pairs();
  const SpatialJoint one_body(pairs[1].first, pairs[1].second, SpatialConstraint::revolute(), 100);
  CHECK(one_body.coordinates() == std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7, 100, 101, 102, 103, 104});
  const SpatialJoint part(pairs[3].first, pairs[3].second, SpatialConstraint::fixed(), 100, std::vector<int>{0, 4});
  CHECK(part.coordinates() == std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7, 100, 101});
}

TEST_CASE("spatial joint tangents in q, v and a are the differences of the residual along the chart") {
  Random random(211);
  each(all(), [&](const SpatialJoint& joint, int rows, const auto&) {
    for (int i = 0; i < 2; ++i) CHECK(testing::tangent_error(joint, State(random, size(joint)), rows) < 1e-8);
  });
}

TEST_CASE("velocity and acceleration levels in space are the time derivatives along a motion of frames and elastics") {
  Random random(212);
  each(all(), [&](const SpatialJoint& joint, int rows, const auto& places) {
    const testing::SpatialMotion motion(random, size(joint), places.frames);
    const auto level = [&](ConstraintLevel at, double t) {
      return VectorXd(testing::rows_of(joint, motion.state(t), at).tail(rows));
    };
    const double t = 0.6, h = 5e-4;
    const VectorXd velocity = level(ConstraintLevel::velocity, t),
                   acceleration = level(ConstraintLevel::acceleration, t);
    const VectorXd d_position =
        testing::derivative([&](double s) { return level(ConstraintLevel::position, s); }, t, h);
    const VectorXd d_velocity =
        testing::derivative([&](double s) { return level(ConstraintLevel::velocity, s); }, t, h);
    CHECK((velocity - d_position).norm() < 1e-8 * (1 + velocity.norm()));
    CHECK((acceleration - d_velocity).norm() < 1e-8 * (1 + acceleration.norm()));
  });
}

TEST_CASE("spatial joints do no work: the power of their forces is lambda times the rate of the constraint") {
  Random random(213);
  each(still(), [&](const SpatialJoint& joint, int rows, const auto&) {
    State s(random, size(joint));
    const Eigen::Index n = size(joint) - rows;
    const VectorXd lambda = s.q.tail(rows), force = testing::rows_of(joint, s).head(n);
    CHECK(force.norm() > 0.01);
    CHECK(force.dot(s.v.head(n)) ==
          Approx(lambda.dot(testing::rows_of(joint, s, ConstraintLevel::velocity).tail(rows))).margin(1e-12));
    const MatrixXd G = testing::tangent_of(joint, s, {0, 0, 0}).topRightCorner(n, rows).transpose();
    s.v.head(n) -= G.completeOrthogonalDecomposition().solve(G * s.v.head(n)).eval();
    CHECK(testing::rows_of(joint, s, ConstraintLevel::velocity).tail(rows).norm() < 1e-12);  // a compatible motion
    CHECK(std::abs(force.dot(s.v.head(n))) < 1e-12);
  });
}

TEST_CASE("rows that are left out leave the others as they are") {
  Random random(214);
  const auto places = testing::spatial_pairs()[0];
  const SpatialJoint whole(places.first, places.second, SpatialConstraint::driven_prismatic(swing()), 100),
      part(places.first, places.second, SpatialConstraint::driven_prismatic(swing()), 100, {1, 3, 5});
  State few(random, size(part)), many(random, size(whole));
  const Eigen::Index n = size(whole) - 6;
  many.q.head(n) = few.q.head(n), many.v.head(n) = few.v.head(n), many.a.head(n) = few.a.head(n);
  many.q.tail(6).setZero();
  for (int i = 0; i < 3; ++i) many.q[n + 1 + 2 * i] = few.q[n + i];
  std::vector<int> independent;
  for (int i = 0; i < n; ++i) independent.push_back(i);
  for (int i : {1, 3, 5}) independent.push_back(static_cast<int>(n) + i);
  CHECK((testing::rows_of(part, few) - testing::picked(testing::rows_of(whole, many), independent)).norm() < 1e-14);
  CHECK((testing::tangent_of(part, few, {1, 2, 3}) -
         testing::picked(testing::tangent_of(whole, many, {1, 2, 3}), independent))
            .norm() < 1e-13);
}

TEST_CASE("a driven joint is held at an angle of many turns and at a position") {
  // the second place, a rigid body's, is put where the first with its axes and the motion say
  const Matrix3d axes = math::rotation({0.4, -0.3, 0.9});
  const Vector3d point(1, -2, 0.5);
  const dynamics::TimeFunction rotations{[](double t) { return 130 * t; }, [](double) { return 130.; },
                                         [](double) { return 0.; }};
  const double t = 0.37;
  const auto C = [&](const SpatialConstraint& constraint, const Matrix3d& rotated, const Vector3d& shift) {
    const auto at = std::make_shared<dynamics::Attitude>(dynamics::Attitude{Eigen::Quaterniond(axes * rotated)});
    SpatialMarker place;
    place.attitude = at, place.coordinates = {0, 1, 2, 3, 4, 5};
    const SpatialJoint joint(SpatialMarker::ground(point, axes), place, constraint, 6);
    Random random;
    State s(random, size(joint));
    s.q.setZero(), s.q.head<3>() = point + axes * shift, s.t = t;
    return VectorXd(testing::rows_of(joint, s).tail(dynamics::rows(constraint)));
  };
  const auto about_z = [](double angle) { return math::rotation({0, 0, angle}); };
  CHECK(C(SpatialConstraint::driven_revolute(rotations), about_z(130 * t), {0, 0, 0}).norm() < 1e-13);
  CHECK(C(SpatialConstraint::driven_revolute(rotations), about_z(130 * t + 0.01), {0, 0, 0})[3] ==
        Approx(std::sin(0.01)).epsilon(1e-10));
  CHECK(C(SpatialConstraint::driven_prismatic(rotations), Matrix3d::Identity(), {0, 0, 130 * t}).norm() < 1e-13);
  CHECK(C(SpatialConstraint::driven_prismatic(rotations), Matrix3d::Identity(), {0, 0, 130 * t + 0.2})[5] ==
        Approx(0.2).epsilon(1e-10));
}

namespace {

/// Shift and rotation (axes of the first place) of the second place.
struct Shifted {
  Vector3d shift;
  Matrix3d rotation;
};

/// The constraint's rows and their gradient by the second place's rigid motion.
std::pair<VectorXd, MatrixXd> constrained(const SpatialConstraint& constraint, const Shifted& by) {
  const Matrix3d axes = math::rotation({-0.7, 0.2, 0.5});
  SpatialMarker place;
  place.attitude = std::make_shared<dynamics::Attitude>(dynamics::Attitude{Eigen::Quaterniond(axes * by.rotation)});
  place.coordinates = {0, 1, 2, 3, 4, 5};
  const SpatialJoint joint(SpatialMarker::ground({3, 1, 2}, axes), place, constraint, 6);
  Random random;
  State s(random, size(joint));
  s.q.setZero(), s.q.head<3>() = Vector3d(3, 1, 2) + axes * by.shift;
  const int rows = dynamics::rows(constraint);
  return {testing::rows_of(joint, s).tail(rows), testing::tangent_of(joint, s, {}).bottomLeftCorner(rows, 6)};
}

Matrix3d rotation_matrix(double x, double y, double z) {
  return (Eigen::AngleAxisd(z, Vector3d::UnitZ()) * Eigen::AngleAxisd(y, Vector3d::UnitY()) *
          Eigen::AngleAxisd(x, Vector3d::UnitX()))
      .toRotationMatrix();
}

}  // namespace

TEST_CASE("what each spatial joint leaves free, and that its rows are independent there") {
  using C = SpatialConstraint;
  const Vector3d none(0, 0, 0);
  struct Case {
    SpatialConstraint constraint;
    Shifted allowed;
    int rows;
  };
  const Case cases[] = {
      {C::fixed(), {none, rotation_matrix(0, 0, 0)}, 6},
      {C::revolute(), {none, rotation_matrix(0, 0, 1.9)}, 5},
      {C::prismatic(), {{0, 0, 1.3}, rotation_matrix(0, 0, 0)}, 5},
      {C::cylindrical(), {{0, 0, 1.3}, rotation_matrix(0, 0, -2.5)}, 4},
      {C::spherical(), {none, rotation_matrix(0.4, -1, 2)}, 3},
      {C::universal(), {none, rotation_matrix(0.6, 0, 1.2)}, 4},  // about z of the first, then x of the second
      {C::planar(), {{0.3, -2, 0}, rotation_matrix(0, 0, 1.1)}, 3},
      {C::distance(3), {{1, -2, 2}, rotation_matrix(0.4, -1, 2)}, 1}};
  for (const Case& c : cases) {
    const auto [rows, gradient] = constrained(c.constraint, c.allowed);
    CHECK(rows.size() == c.rows);
    CHECK(rows.norm() < 1e-14);
    CHECK(gradient.jacobiSvd().singularValues().minCoeff() > 0.5);
    const Shifted away{c.allowed.shift + Vector3d(0.1, 0.2, 0.3), c.allowed.rotation * rotation_matrix(0.1, 0.2, 0.3)};
    CHECK(constrained(c.constraint, away).first.norm() > 0.05);
  }
}

TEST_CASE(
    "multipliers of point rows are forces, of orientation rows moments on the second place about the axes named") {
  const auto moment = [](const SpatialConstraint& constraint, int row) {
    return Vector3d(constrained(constraint, {Vector3d::Zero(), Matrix3d::Identity()}).second.row(row).tail(3));
  };
  using C = SpatialConstraint;  // body axes of the second place are its own axes here
  CHECK((moment(C::fixed(), 3) - Vector3d::UnitZ()).norm() < 1e-14);
  CHECK((moment(C::fixed(), 4) - Vector3d::UnitX()).norm() < 1e-14);
  CHECK((moment(C::fixed(), 5) - Vector3d::UnitY()).norm() < 1e-14);
  CHECK((moment(C::revolute(), 3) + Vector3d::UnitY()).norm() < 1e-14);
  CHECK((moment(C::revolute(), 4) - Vector3d::UnitX()).norm() < 1e-14);
}

TEST_CASE("a distance joint says when there is nothing to measure along") {
  CHECK_THROWS_AS(SpatialConstraint::distance(0), InputError);
  CHECK_THROWS_AS(SpatialConstraint::distance(-1), InputError);
  CHECK_THROWS_AS(constrained(SpatialConstraint::distance(2), {Vector3d::Zero(), Matrix3d::Identity()}), RunError);
}

TEST_CASE("in the plane spatial joints are the planar ones") {
  Random random(215);
  const auto one = testing::framed_marker(random, 0), other = testing::framed_marker(random, 5);
  const auto still = std::make_shared<dynamics::Attitude>();
  const auto first = testing::in_space(one, still), second = testing::in_space(other, still, 8);
  const std::vector<int> body{0, 1, 5, 6, 7, 8, 9, 13, 14, 15};
  const auto compare = [&](const dynamics::Constraint& flat, const SpatialConstraint& constraint,
                           const std::vector<int>& independent, const State& s) {
    const int rows = dynamics::rows(flat);
    const dynamics::Joint planar(one, other, flat, first_multiplier);
    const SpatialJoint joint(first, second, constraint, first_multiplier, independent);
    std::vector<int> where = body;
    for (int i = 0; i < rows; ++i) where.push_back(16 + i);
    const State lifted = testing::in_space(s, where, 16 + rows);
    for (auto level : {ConstraintLevel::position, ConstraintLevel::velocity, ConstraintLevel::acceleration})
      CHECK(
          (testing::picked(testing::rows_of(joint, lifted, level), where) - testing::rows_of(planar, s, level)).norm() <
          1e-12);
    CHECK((testing::picked(testing::tangent_of(joint, lifted, {1, 2, 3}), where) -
           testing::tangent_of(planar, s, {1, 2, 3}))
              .norm() < 1e-12);
  };
  compare(dynamics::Revolute{}, SpatialConstraint::revolute(), {0, 1}, State(random, 12));
  // angles are constrained by their sine in space: the same where the constraint is met
  State met(random, 13);
  met.q[7] = met.q[2] + one.angle0 - other.angle0 + one.psi.dot(met.q.segment<2>(3)) -
             other.psi.dot(met.q.segment<2>(8)) + swing().value(met.t);
  compare(dynamics::Clamp{0, swing()}, SpatialConstraint::driven_revolute(swing()), {0, 1, 3}, met);
  State slid(random, 12);
  slid.q[7] =
      slid.q[2] + one.angle0 - other.angle0 + one.psi.dot(slid.q.segment<2>(3)) - other.psi.dot(slid.q.segment<2>(8));
  compare(dynamics::Prismatic{{0, 1}, 0.2, 0}, {{dynamics::Along{1, 0.2}, dynamics::Product{1, 0}}}, {0, 1}, slid);
}

TEST_CASE("a spatial joint knows when its axes point the other way") {
  const auto rotated = [](const Vector3d& axis, double angle) {
    return SpatialMarker::ground(Vector3d::Zero(), Eigen::AngleAxisd(angle, axis).toRotationMatrix());
  };
  const dynamics::TimeFunction to_pi{[](double t) { return t * M_PI; }, [](double) { return M_PI; },
                                     [](double) { return 0.0; }};
  const auto right = [&](const SpatialConstraint& constraint, const Vector3d& axis, double angle, double t) {
    const SpatialJoint joint(rotated(axis, 0), rotated(axis, angle), constraint, first_multiplier);
    const VectorXd q = VectorXd::Zero(dynamics::rows(constraint)), none = q;
    VectorXd r = q;
    joint.residual({t, q, none, none}, r);
    CHECK(r.norm() < 1e-12);  // the rows do not tell
    return joint.constraint_status({t, q, none, none}) == dynamics::ConstraintStatus::satisfied;
  };
  using C = SpatialConstraint;
  const Vector3d x = Vector3d::UnitX(), z = Vector3d::UnitZ();
  CHECK(right(C::fixed(), z, 0, 0));
  CHECK_FALSE(right(C::fixed(), z, M_PI, 0));
  CHECK(right(C::revolute(), z, 2, 0));
  CHECK_FALSE(right(C::revolute(), x, M_PI, 0));
  CHECK(right(C::driven_revolute(to_pi), z, M_PI, 1));
  CHECK_FALSE(right(C::driven_revolute(to_pi), z, 0, 1));
  CHECK(right(C::spherical(), x, M_PI, 0));
}

TEST_CASE("a spatial joint looks after the rows that are left out") {
  const std::vector<int> independent{0, 1, 2};
  const VectorXd q = VectorXd::Zero(3), none = q;
  const auto stands = [&](const Vector3d& point, double angle, double unit) {
    const Matrix3d axes = Eigen::AngleAxisd(angle, Vector3d::UnitX()).toRotationMatrix();
    return SpatialJoint(SpatialMarker::ground(Vector3d::Zero()), SpatialMarker::ground(point, axes),
                        SpatialConstraint::driven_prismatic({}), first_multiplier, independent, unit)
        .constraint_status({0, q, none, none});
  };
  using dynamics::ConstraintStatus;
  CHECK(stands({0, 0, 0}, 0, 1) == ConstraintStatus::satisfied);
  CHECK(stands({0, 0, 0.01}, 0, 1) == ConstraintStatus::violated);
  CHECK(stands({0, 0, 0.01}, 0, 20) == ConstraintStatus::satisfied);
  CHECK(stands({0, 0, 0}, 0.01, 20) == ConstraintStatus::violated);
}
