#include "floe/dynamics/state_force.h"

#include <catch2/catch.hpp>

#include "floe/dynamics/fixed_frame_body.h"
#include "floe/dynamics/joint_force.h"
#include "floe/dynamics/joints.h"
#include "floe/dynamics/pressure_load.h"
#include "floe/dynamics/spatial_force.h"
#include "spatial_terms.h"

using namespace floe;
using dynamics::CoordinateSensor;
using dynamics::JointForce;
using dynamics::PlanarCoordinate;
using dynamics::Sensor;
using dynamics::SpatialCoordinate;
using dynamics::StateForce;
using testing::Random;
using testing::State;
using Of = dynamics::RelativeCoordinate::Of;

namespace {

const math::Formula law = math::Formula::of_sensors("0.7*sin(1.3*a.x + t) - 0.4*b.x^2*a.x + 0.2*exp(0.5*b.x)", {});

std::unique_ptr<dynamics::RelativeCoordinate> of_pair(const dynamics::Marker& first, const dynamics::Marker& second,
                                                      Of of) {
  return std::make_unique<PlanarCoordinate>(first, second, of, 0.1, Eigen::Vector2d(0.6, 0.8));
}
std::unique_ptr<dynamics::RelativeCoordinate> of_pair(const dynamics::SpatialMarker& first,
                                                      const dynamics::SpatialMarker& second, Of of) {
  return std::make_unique<SpatialCoordinate>(first, second, of, 0.1);
}

/// A load on a joint that depends on a coordinate of a pair and on its rate.
template <class Marker>
StateForce on_joint(const Marker& first, const Marker& second, Of on, Of sensed) {
  auto unit = std::make_unique<JointForce>(of_pair(first, second, on), [](double, double) {
    return dynamics::ForceOnCoordinate{-1, 0, 0, 0};
  });
  std::vector<std::unique_ptr<Sensor>> sensors;
  sensors.push_back(std::make_unique<CoordinateSensor>(of_pair(first, second, sensed), false));
  sensors.push_back(std::make_unique<CoordinateSensor>(of_pair(second, first, sensed), true));
  return {std::move(unit), std::make_shared<dynamics::StateFormula>(law, std::move(sensors))};
}

/// Also with frames that have rotated from their bases.
template <class Term>
void check_tangent(Term&& term, Random& random) {
  const State s(random, static_cast<Eigen::Index>(term.coordinates().size()));
  CHECK(testing::rows_of(term, s).norm() > 1e-3);
  CHECK(testing::tangent_error(term, s) < 1e-8);
}

constexpr Of all[] = {Of::slide, Of::rotation, Of::length};

}  // namespace

TEST_CASE("loads of joints in the plane that depend on the state have exact tangents") {
  Random random(311);
  for (const auto& [first, second] : testing::place_pairs())
    for (const Of on : all)
      for (const Of sensed : all) check_tangent(on_joint(first, second, on, sensed), random);
}

TEST_CASE("loads of joints in space that depend on the state have exact tangents") {
  Random random(312);
  for (const auto& places : testing::spatial_pairs())
    for (const Of on : all)
      for (const Of sensed : all) check_tangent(on_joint(places.first, places.second, on, sensed), random);
}

TEST_CASE("forces on places in space that depend on rotations and angular velocities have exact tangents") {
  Random random(313);
  for (const auto& places : testing::spatial_pairs())
    for (const auto axes : {dynamics::SpatialForce::Axes::world, dynamics::SpatialForce::Axes::body,
                            dynamics::SpatialForce::Axes::place}) {
      dynamics::Wrench w;
      w << random.vector(3), random.vector(3);
      std::vector<std::unique_ptr<Sensor>> sensors;
      for (const bool rate : {false, true})
        sensors.push_back(std::make_unique<dynamics::SpatialRotationSensor>(places.first, places.second, 1, rate));
      check_tangent(StateForce(std::make_unique<dynamics::SpatialForce>(
                                   places.first.coordinates.empty() ? places.second : places.first,
                                   [w](double) { return w; }, axes),
                               std::make_shared<dynamics::StateFormula>(law, std::move(sensors))),
                    random);
    }
}

TEST_CASE("a sensor's rate is the derivative of its value along a motion") {
  Random random(314);
  for (const auto& places : testing::spatial_pairs())
    for (const Of of : all) {
      const CoordinateSensor x(of_pair(places.first, places.second, of), false),
          rate(of_pair(places.first, places.second, of), true);
      const testing::SpatialMotion motion(random, static_cast<Eigen::Index>(x.coordinates().size()), places.frames);
      const auto at = [&](double t) {
        const State s = motion.state(t);
        return x.value({s.t, s.q, s.v, s.a});
      };
      const State s = motion.state(0.4);
      CHECK(rate.value({s.t, s.q, s.v, s.a}) == Approx(testing::derivative(at, 0.4, 5e-4)).epsilon(1e-7).margin(1e-8));
    }
}

TEST_CASE("a load of size 1 is the load itself, and a moment of a joint is what it exerts") {
  Random random(315);
  const auto pairs = testing::spatial_pairs();
  const StateForce force = on_joint(pairs[0].first, pairs[0].second, Of::rotation, Of::rotation);
  const State s(random, static_cast<Eigen::Index>(force.coordinates().size()));
  const CoordinateSensor a(of_pair(pairs[0].first, pairs[0].second, Of::rotation), false),
      b(of_pair(pairs[0].first, pairs[0].second, Of::rotation), true);
  const dynamics::Motion motion{s.t, s.q, s.v, s.a};
  const double size = law.value(std::array{s.t, a.value(motion), -b.value(motion)});
  const JointForce unit(of_pair(pairs[0].first, pairs[0].second, Of::rotation), [](double, double) {
    return dynamics::ForceOnCoordinate{-1, 0, 0, 0};
  });
  CHECK((testing::rows_of(force, s) - size * testing::rows_of(unit, s)).norm() < 1e-14);
  CHECK((force.on_second(motion) - size * unit.on_second(motion)).norm() < 1e-14);
  CHECK(unit.on_second(motion).tail<3>().norm() > 0.5);
}

TEST_CASE("friction resists the rate with its level, and has exact tangents") {
  Random random(316);
  const dynamics::FrictionLaw friction{2, 0.3, 0.8};
  CHECK(friction(0, 1e3).force == Approx(2 + 300));
  CHECK(friction(0, -1e3).force == Approx(-2 - 300));
  for (const auto& [first, second] : testing::place_pairs())
    for (const Of of : {Of::slide, Of::rotation})
      check_tangent(JointForce(of_pair(first, second, of), friction), random);
  for (const auto& places : testing::spatial_pairs())
    for (const Of of : {Of::slide, Of::rotation})
      check_tangent(JointForce(of_pair(places.first, places.second, of), friction), random);
}

TEST_CASE("pressures and forces along the elements that depend on the state have exact tangents") {
  Random random(317);
  const math::Formula two = math::Formula::of_sensors("0.7*sin(1.3*a.x + t) - 0.4*b.x^2*a.x", {});
  const auto places = testing::spatial_pairs().front();
  body::Pressure unit(2);
  unit.force = random.vector(3), unit.moment = random.vector(3), unit.load = random.vector(2);
  unit.force_by = random.matrix(3, 2), unit.moment_by = random.matrix(3, 2), unit.load_by = random.matrix(2, 2);
  unit.spread = random.matrix(3, 3);
  for (Eigen::Matrix3d& by : unit.spread_by) by = random.matrix(3, 3);
  const auto sensors = [&] {
    std::vector<std::unique_ptr<Sensor>> all;
    all.push_back(std::make_unique<CoordinateSensor>(of_pair(places.first, places.second, Of::slide), false));
    all.push_back(std::make_unique<CoordinateSensor>(of_pair(places.first, places.second, Of::slide), true));
    return std::make_shared<dynamics::StateFormula>(two, std::move(all));
  };
  const auto one = [](double) { return 1.; };
  for (const auto kind : {dynamics::PressureLoad::Kind::follower, dynamics::PressureLoad::Kind::dead})
    check_tangent(StateForce(std::make_unique<dynamics::PressureLoad>(std::vector<int>{90, 91}, nullptr, unit, one,
                                                                      kind, Eigen::Matrix3d::Identity()),
                             sensors()),
                  random);
  const Eigen::MatrixXd S = random.matrix(3, 2);
  const std::vector<Eigen::MatrixXd> Q(3, Eigen::MatrixXd::Identity(2, 2));
  check_tangent(StateForce(std::make_unique<dynamics::DeadForce>(
                               std::vector<int>{90, 91}, S,
                               [](double) -> Eigen::VectorXd { return Eigen::Vector3d(1, 2, 3); }, Q),
                           sensors()),
                random);
}
