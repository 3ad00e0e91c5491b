#include "floe/dynamics/stop.h"

#include <catch2/catch.hpp>

#include "spatial_terms.h"

using namespace floe;
using dynamics::PlanarCoordinate;
using dynamics::SpatialCoordinate;
using dynamics::Stop;
using dynamics::StopLaw;
using Eigen::VectorXd;
using testing::Random;
using testing::State;

namespace {

/// So narrow that random states are beyond a limit: some within the width, some behind it.
const StopLaw damped{-0.02, 0.01, 3, 0.7, 0.9}, undamped{-0.02, 0.01, 3, 0, 0.9};

/// Every kind of stop between every pair of places.
template <class Test>
void each(const StopLaw& law, const Test& test) {
  using Of = dynamics::RelativeCoordinate::Of;
  for (const auto& [first, second] : testing::place_pairs()) {
    test(Stop(std::make_unique<PlanarCoordinate>(first, second, Of::rotation, 0.1), law));
    test(Stop(std::make_unique<PlanarCoordinate>(first, second, Of::slide, 0.1, Eigen::Vector2d(0.6, 0.8)), law));
  }
  for (const auto& places : testing::spatial_pairs())
    for (const auto of : {Of::rotation, Of::slide})
      test(Stop(std::make_unique<SpatialCoordinate>(places.first, places.second, of, 0.1), law));
}

Eigen::Index size(const dynamics::Term& term) { return static_cast<Eigen::Index>(term.coordinates().size()); }

}  // namespace

TEST_CASE("the force of a stop is the derivative of its energy, and continuous with its slopes") {
  for (const double x : {-2., -0.5, -0.0201, 0., 0.0101, 0.5, 2.}) {
    const auto at = damped.at(x, 0);
    CHECK(at.force == Approx(testing::derivative([&](double y) { return damped.at(y, 0).energy; }, x, 1e-5)));
    const auto moving = damped.at(x, 0.4);
    CHECK(moving.by_x == Approx(testing::derivative([&](double y) { return damped.at(y, 0.4).force; }, x, 1e-5)));
    CHECK(moving.by_rate == Approx((damped.at(x, 0.5).force - damped.at(x, 0.3).force) / 0.2).margin(1e-14));
  }
  for (const double joint : {-0.02 - 0.9, -0.02, 0.01, 0.01 + 0.9}) {
    const auto below = damped.at(joint - 1e-9, 0.4), above = damped.at(joint + 1e-9, 0.4);
    CHECK(std::abs(above.force - below.force) < 1e-7);
    CHECK(std::abs(above.by_x - below.by_x) < 1e-7);
  }
}

// Within the width and behind it: differences across the ends of the width would see the jump of second derivatives.
TEST_CASE("tangents of stops are the differences of the force, damping included") {
  for (const StopLaw& law : {StopLaw{-0.02, 0.01, 3, 0.7, 50}, StopLaw{-0.02, 0.01, 3, 0.7, 1e-4}}) {
    Random random(241);
    int hit = 0;
    each(law, [&](const dynamics::Stop& stop) {
      const State s(random, size(stop));
      hit += testing::rows_of(stop, s).norm() > 1e-4;
      CHECK(testing::tangent_error(stop, s) < 1e-7);
    });
    CHECK(hit == 24);
  }
}

TEST_CASE("undamped stops give back as power what they lose of energy") {
  Random random(242);
  for (const auto& places : testing::spatial_pairs())
    for (const auto of : {dynamics::RelativeCoordinate::Of::rotation, dynamics::RelativeCoordinate::Of::slide}) {
      const Stop stop(std::make_unique<SpatialCoordinate>(places.first, places.second, of, 0.1), undamped);
      const testing::SpatialMotion motion(random, size(stop), places.frames);
      const State s = motion.state(0.4);
      const auto energy = [&](double t) {
        const State at = motion.state(t);
        return stop.energy({at.t, at.q, at.v, at.a}).elastic;
      };
      CHECK(testing::rows_of(stop, s).dot(s.v) ==
            Approx(testing::derivative(energy, 0.4, 5e-4)).epsilon(1e-7).margin(1e-8));
    }
}
