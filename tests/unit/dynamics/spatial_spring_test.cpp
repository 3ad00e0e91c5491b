#include "floe/dynamics/spatial_spring.h"

#include <catch2/catch.hpp>

#include "floe/dynamics/joints.h"
#include "floe/error.h"
#include "spatial_terms.h"

using namespace floe;
using dynamics::SpatialBushing;
using dynamics::SpatialMarker;
using dynamics::SpatialSpring;
using dynamics::Wrench;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;
using testing::Random;
using testing::State;

namespace {

const dynamics::SpatialSpringProperties damped{3, 0.7, 0.4, 2, 0.3, -0.2}, undamped{3, 0, 0.4, 2, 0, -0.2};

dynamics::BushingProperties bushing(bool with_viscosity) {
  dynamics::BushingProperties p;
  p.stiffness << 3, 1, 2, 0.5, 1.5, 2.5;
  if (with_viscosity) p.viscosity << 0.2, 0.5, 0.1, 0.6, 0.3, 0.4;
  return p;
}

/// Calls `test(term, places)` for a spring and a bushing between every pair of places.
template <class Test>
void each(bool with_viscosity, const Test& test) {
  for (const auto& places : testing::spatial_pairs()) {
    test(SpatialSpring(places.first, places.second, with_viscosity ? damped : undamped), places);
    test(SpatialBushing(places.first, places.second, bushing(with_viscosity)), places);
  }
}

Eigen::Index size(const dynamics::Term& term) { return static_cast<Eigen::Index>(term.coordinates().size()); }

double elastic(const dynamics::Term& term, const State& s) { return term.energy({s.t, s.q, s.v, s.a}).elastic; }

/// A rigid body's place with the coordinates 0..5, rotated by `rotation` from world axes.
SpatialMarker rigid(const Matrix3d& rotation = Matrix3d::Identity()) {
  SpatialMarker place;
  place.attitude = std::make_shared<dynamics::Attitude>(dynamics::Attitude{Eigen::Quaterniond(rotation)});
  place.coordinates = {0, 1, 2, 3, 4, 5};
  return place;
}

State at_rest() {
  Random none;
  State s(none, 6);
  s.q.setZero(), s.v.setZero(), s.a.setZero();
  return s;
}

}  // namespace

TEST_CASE(
    "tangents of springs and bushings in space are the differences of the force along the chart, damping included") {
  Random random(231);
  each(true, [&](const dynamics::Term& term, const auto&) {
    for (int i = 0; i < 2; ++i) CHECK(testing::tangent_error(term, State(random, size(term))) < 1e-7);
  });
}

TEST_CASE("undamped springs and bushings in space give back as power what they lose of energy") {
  Random random(232);
  each(false, [&](const dynamics::Term& term, const auto& places) {
    const testing::SpatialMotion motion(random, size(term), places.frames);
    const State s = motion.state(0.4);
    const double rate = testing::derivative([&](double t) { return elastic(term, motion.state(t)); }, 0.4, 5e-4);
    CHECK(std::abs(rate) > 0.01);
    CHECK(testing::rows_of(term, s).dot(s.v) == Approx(rate).epsilon(1e-8).margin(1e-9));
  });
}

TEST_CASE("dampers in space take power out of the motion, with the square of the speed") {
  Random random(233);
  each(true, [&](const dynamics::Term& term, const auto&) {
    State s(random, size(term)), rest = s;
    rest.v.setZero();
    const auto spent = [&](double speed) {
      State moving = s;
      moving.v *= speed;
      return (testing::rows_of(term, moving) - testing::rows_of(term, rest)).dot(moving.v);
    };
    CHECK(spent(1) > 0);
    CHECK(spent(0.5) == Approx(spent(1) / 4).epsilon(1e-9));
  });
}

TEST_CASE("a spring in space between two points of a line, and torsion about z: Hooke and Newton") {
  const SpatialSpring spring(SpatialMarker::ground({0, 0, 0}, math::rotation({0, 0, 0.5})), rigid(), damped);
  State s = at_rest();
  s.q << 2, 3, 6, 0, 0, 0.9;        // length 7
  s.v << 1, 2, -1, 0.2, -0.1, 0.6;  // lengthening 2/7
  const double f = 3 * (7 - 0.4) + 0.7 * 2 / 7, m = 2 * (0.9 - 0.5 + 0.2) + 0.3 * 0.6;
  CHECK((testing::rows_of(spring, s) - (Wrench() << f * Vector3d(2, 3, 6) / 7, 0, 0, m).finished()).norm() < 1e-13);
  CHECK(elastic(spring, s) == Approx(0.5 * 3 * 6.6 * 6.6 + 0.5 * 2 * 0.36).epsilon(1e-14));
}

TEST_CASE("the twist is the angle about z between axes that are inclined to each other") {
  // D1'D2 = (an inclination about an axis in the plane x, y) times (a rotation about z)
  for (const double angle : {-2.0, 0.3, 1.7}) {
    const Matrix3d rotated = math::rotation({0.8, -0.4, 0}) * math::rotation({0, 0, angle});
    const SpatialSpring spring(SpatialMarker::ground({0, 0, 0}), rigid(rotated), {0, 0, 0, 2, 0, 0});
    CHECK(elastic(spring, at_rest()) == Approx(angle * angle).epsilon(1e-13));
  }
}

TEST_CASE("a torsional spring follows its turns when it is told to, and knows half a turn otherwise") {
  const auto moment = [](const SpatialSpring& spring, double angle) {
    State s = at_rest();
    s.q[5] = angle;
    return testing::rows_of(spring, s)[5];
  };
  SpatialSpring spring(SpatialMarker::ground({0, 0, 0}), rigid(), {0, 0, 0, 2, 0, 0.5});
  CHECK(moment(spring, 0.5 + 3.1) == Approx(2 * 3.1).epsilon(1e-13));
  CHECK(moment(spring, 0.5 + 3.2) == Approx(2 * (3.2 - 2 * M_PI)).epsilon(1e-13));
  for (int step = 1; step <= 10; ++step) {
    State s = at_rest();
    s.q[5] = 2.0 * step;
    spring.begin_step({0, s.q, s.v, s.a});
  }
  CHECK(moment(spring, 21) == Approx(2 * 20.5).epsilon(1e-13));
}

// Of 200 rad/s, 20 rad are expected after 0.1 s; beginnings with 200 and 300 rad/s are 25 rad apart by their mean.
TEST_CASE("a torsional spring counts several revolutions within a step, by its rate") {
  SpatialSpring spring(SpatialMarker::ground({0, 0, 0}), rigid(), {0, 0, 0, 2, 0, 0});
  const auto begin = [&](double t, double angle, double rate) {
    State s = at_rest();
    s.q[5] = angle, s.v[5] = rate;
    spring.begin_step({t, s.q, s.v, s.a});
  };
  const auto moment = [&](double t, double angle) {
    const State s = [&] {
      State at = at_rest();
      at.q[5] = angle;
      return at;
    }();
    Eigen::VectorXd r = Eigen::VectorXd::Zero(s.q.size());
    spring.residual({t, s.q, s.v, s.a}, r);
    return r[5];
  };
  begin(0, 2, 0);
  begin(0, 2, 200);
  CHECK(moment(0.1, 2 + 21) == Approx(2 * (2 + 21)).epsilon(1e-13));
  CHECK(moment(0.1, 2 + 21 + 6 * M_PI) == Approx(2 * (2 + 21)).epsilon(1e-13));
  begin(0.1, 2 + 24, 300);
  CHECK(moment(0.1, 2 + 24) == Approx(2 * (2 + 24)).epsilon(1e-13));
  std::vector<double> numbers;
  spring.save(numbers);
  SpatialSpring other(SpatialMarker::ground({0, 0, 0}), rigid(), {0, 0, 0, 2, 0, 0});
  other.load(numbers);
  State s = at_rest();
  s.q[5] = 2 + 24 + 30;
  CHECK(elastic(other, s) == Approx(elastic(spring, s)).epsilon(1e-14));
}

TEST_CASE("a torsional spring between opposite axes has no twist to work with") {
  const SpatialSpring spring(SpatialMarker::ground({0, 0, 0}), rigid(math::rotation({M_PI, 0, 0})), damped);
  CHECK_THROWS_AS(testing::rows_of(spring, at_rest()), RunError);
}

TEST_CASE("places in space that coincide have no line of action: torsion alone, and finite numbers") {
  const SpatialSpring spring(SpatialMarker::ground({0, 0, 0}), rigid(), damped);
  State s = at_rest();
  s.q[5] = 0.3, s.v.setOnes();
  const VectorXd r = testing::rows_of(spring, s);
  CHECK(r.head(5).norm() < 1e-15);
  CHECK(r[5] == Approx(2 * (0.3 + 0.2) + 0.3).epsilon(1e-14));
  CHECK(testing::tangent_of(spring, s, {1, 1, 1}).allFinite());
}

TEST_CASE("a spring of length zero is linear in space, also where its places coincide") {
  const SpatialSpring spring(SpatialMarker::ground({0, 0, 0}), rigid(), {3, 0, 0, 0, 0, 0});
  for (const Vector3d& p : {Vector3d(0, 0, 0), Vector3d(0.1, -0.2, 0.3)}) {
    State s = at_rest();
    s.q.head<3>() = p;
    CHECK((testing::rows_of(spring, s).head<3>() - 3 * p).norm() < 1e-15);
    CHECK((testing::tangent_of(spring, s, {1, 0, 0}).topLeftCorner<3, 3>() - 3 * Matrix3d::Identity()).norm() < 1e-14);
  }
}

TEST_CASE("a bushing counts its angle beyond half a turn, and refuses a turn") {
  dynamics::BushingProperties p;
  p.stiffness[5] = 2, p.name = "b";
  SpatialBushing term(SpatialMarker::ground({0, 0, 0}), rigid(), p);
  State s = at_rest();
  for (const double angle : {1.0, 3.0, 4.0, 5.0}) {
    s.q[5] = angle;
    CHECK(testing::rows_of(term, s)[5] == Approx(2 * angle));
    term.begin_step({0, s.q, s.v, s.a});
  }
  s.q[5] = 5.5;
  CHECK(testing::rows_of(term, s)[5] == Approx(11));
  CHECK_THROWS_WITH(term.begin_step({0, s.q, s.v, s.a}), Catch::Contains("bushing b is rotated by 5.5 rad"));
}

TEST_CASE("a bushing carries nothing at its rest") {
  auto p = bushing(false);
  p.rest << 1, 2, 3;
  const SpatialBushing term(SpatialMarker::ground({0, 0, 0}), rigid(), p);
  State s = at_rest();
  s.q.head<3>() << 1, 2, 3;
  CHECK(testing::rows_of(term, s).norm() < 1e-14);
  s.q[0] += 0.1;
  CHECK(testing::rows_of(term, s)[0] == Approx(0.1 * p.stiffness[0]));
}

TEST_CASE("a bushing at rest is six springs in the axes of its first place") {
  const Matrix3d axes = math::rotation({0.3, 0.8, -0.5});
  const SpatialBushing term(SpatialMarker::ground({1, 2, 3}, axes), rigid(axes), bushing(true));
  State s = at_rest();
  s.q.head<3>() << 1, 2, 3;
  CHECK(testing::rows_of(term, s).norm() < 1e-14);
  Eigen::Matrix<double, 6, 6> K = Eigen::Matrix<double, 6, 6>::Zero(), C = K;
  const auto p = bushing(true);
  K.topLeftCorner<3, 3>() = axes * p.stiffness.head<3>().asDiagonal() * axes.transpose();
  C.topLeftCorner<3, 3>() = axes * p.viscosity.head<3>().asDiagonal() * axes.transpose();
  K.bottomRightCorner<3, 3>() = p.stiffness.tail<3>().asDiagonal();  // rows are moments about the body's axes
  C.bottomRightCorner<3, 3>() = p.viscosity.tail<3>().asDiagonal();
  CHECK((testing::tangent_of(term, s, {1, 0, 0}) - K).norm() < 1e-13);
  CHECK((testing::tangent_of(term, s, {0, 1, 0}) - C).norm() < 1e-13);
  s.q.tail<3>() << 0.5, 0, 0;  // about x, finite: a plain torsion spring
  CHECK(elastic(term, s) == Approx(0.5 * 0.5 * 0.25).epsilon(1e-13));
  CHECK((testing::rows_of(term, s).tail<3>() - Vector3d(0.25, 0, 0)).norm() < 1e-14);
}

TEST_CASE("in the plane a spatial spring is the planar one") {
  Random random(234);
  const auto one = testing::framed_marker(random, 0), other = testing::framed_marker(random, 5);
  const auto still = std::make_shared<dynamics::Attitude>();
  const dynamics::Spring planar(one, other, {3, 0.7, 0.4, 2, 0.3, -0.2});
  SpatialSpring spring(testing::in_space(one, still), testing::in_space(other, still, 8), damped);
  const std::vector<int> where{0, 1, 5, 6, 7, 8, 9, 13, 14, 15};
  for (int i = 0; i < 3; ++i) {
    State s(random, 10);
    s.q *= 0.5;
    const State lifted = testing::in_space(s, where, 16);
    CHECK((testing::picked(testing::rows_of(spring, lifted), where) - testing::rows_of(planar, s)).norm() < 1e-13);
    CHECK((testing::picked(testing::tangent_of(spring, lifted, {1, 2, 3}), where) -
           testing::tangent_of(planar, s, {1, 2, 3}))
              .norm() < 1e-12);
    CHECK(elastic(spring, lifted) == Approx(elastic(planar, s)).epsilon(1e-12));
  }
}
