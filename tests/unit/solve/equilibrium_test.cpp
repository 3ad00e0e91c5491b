#include <catch2/catch.hpp>
#include <cmath>
#include <optional>

#include "floe/dynamics/spatial_force.h"
#include "floe/dynamics/spatial_joint.h"
#include "floe/dynamics/spatial_spring.h"
#include "floe/solve/start.h"
#include "spatial_systems.h"

using namespace floe;
using dynamics::SpatialMarker;
using Eigen::Vector3d;
using Eigen::VectorXd;
using testing::numbers_of;
using testing::vector_of;

namespace {

/// A rigid body in space whose place at `arm` from its frame is constrained to the ground there, in one of two ways,
/// under a moment about z.
struct Held {
  std::shared_ptr<dynamics::Attitude> attitude = std::make_shared<dynamics::Attitude>();
  std::unique_ptr<dynamics::System> system;

  SpatialMarker place(const Vector3d& x) const {
    SpatialMarker marker;
    marker.attitude = attitude, marker.coordinates = {0, 1, 2, 3, 4, 5}, marker.x0 = x;
    return marker;
  }
  Held(const Vector3d& arm, double moment, const std::optional<dynamics::BushingProperties>& bushing) {
    dynamics::Coordinates coordinates(PETSC_COMM_SELF);
    coordinates.belongs_to("body bar");
    coordinates.add_shared(6);
    coordinates.belongs_to("joint hinge");
    if (!bushing) coordinates.add_shared(5, true);
    coordinates.number();
    testing::Terms terms;
    terms.push_back(std::make_unique<dynamics::SpatialBody>(
        std::vector<int>{0, 1, 2, 3, 4, 5}, attitude, testing::rigid(2, {0.1, 0.2, 0.2}), testing::no_elasticity()));
    if (bushing)
      terms.push_back(std::make_unique<dynamics::SpatialBushing>(SpatialMarker::ground(arm), place(arm), *bushing));
    else
      terms.push_back(std::make_unique<dynamics::SpatialJoint>(SpatialMarker::ground(arm), place(arm),
                                                               dynamics::SpatialConstraint::revolute(), 6));
    terms.push_back(std::make_unique<dynamics::SpatialForce>(
        place(arm),
        [moment](double) {
          dynamics::Wrench w = dynamics::Wrench::Zero();
          w[5] = moment;
          return w;
        },
        dynamics::SpatialForce::Axes::world));
    system = std::make_unique<dynamics::System>(coordinates, std::move(terms), dynamics::Attitudes{{3, attitude}});
  }
  VectorXd rest() const {
    const petsc::VecHandle U = system->create_vector(), V = system->create_vector();
    solve::equilibrium(*system, 1, U, V);
    return numbers_of(U);
  }
};

dynamics::BushingProperties bushing(double k, double about_z) {
  dynamics::BushingProperties properties;
  properties.stiffness << k, k, k, 1e3, 1e3, about_z;
  return properties;
}

}  // namespace

TEST_CASE("equilibrium on a bushing that an arm hides: the turn M / k, or words, but no other turn") {
  for (const double length : {0., 1., 30., 1e3, 1e4, 1e6})
    for (const double k : {1e6, 1e8, 1e10})
      for (const double about_z : {10., 100.}) {
        INFO("arm " << length << ", k " << k << ", about z " << about_z);
        const Held body(length * Vector3d(1, 0.3, 0.1), 10, bushing(k, about_z));
        const double hidden = k * length * length * PETSC_MACHINE_EPSILON / about_z;  // round-off of the arm's share
        double rotation = 10 / about_z;
        try {
          rotation = body.rest()[5];
        } catch (const solve::Unconstrained&) {
          CHECK(hidden > 1e-3);
        } catch (const solve::LostInRoundOff&) {
          CHECK(hidden > 1e-3);
        }
        CHECK(std::abs(rotation - 10 / about_z) < 1e-6);
      }
}

TEST_CASE("equilibrium: where a bushing leaves a turn open that a load drives, no arm makes it a stiffness") {
  for (const double length : {0., 1., 1e2, 1e4})
    for (const double k : {1e3, 1e6, 1e9, 1e12})
      for (const double moment : {1e-6, 1., 10.}) {
        INFO("arm " << length << ", k " << k << ", moment " << moment);
        const Held body(length * Vector3d(1, 0.3, 0.1), moment, bushing(k, 0));
        CHECK_THROWS_AS(body.rest(), RunError);
      }
}

TEST_CASE("equilibrium of a hinge in space under a moment about it: nothing holds the body") {
  for (const double length : {0., 1., 1e3})
    for (const double moment : {1e-6, 1., 1e4}) {
      INFO("arm " << length << ", moment " << moment);
      const Held body(length * Vector3d(0.6, 0.8, 0), moment, {});
      CHECK_THROWS_AS(body.rest(), solve::Unconstrained);
      CHECK_THROWS_WITH(body.rest(), Catch::Contains("singular tangent stiffness (body bar)"));
    }
}
