#include "../../../src/app/campbell_estimate.h"

#include <catch2/catch.hpp>

using namespace floe;
using namespace floe::app;

TEST_CASE("errors of frequencies are against the nearest of the larger model, each used once") {
  const auto at = [](int track, double omega) {
    TrackedVibration one;
    one.track = track, one.omega = omega;
    return one;
  };
  const auto of_larger = [](double omega) {
    solve::Vibration one;
    one.omega = omega;
    return one;
  };
  CampbellPoint point;
  point.vibrations = {at(0, 0), at(1, 10), at(2, 10.5), at(3, 44)};
  const auto errors =
      frequency_errors(point, {of_larger(0), of_larger(5), of_larger(9.8), of_larger(10), of_larger(40)});
  REQUIRE(errors.size() == 3);  // none of a zero
  CHECK(errors[0].track == 1);
  CHECK(errors[0].relative == 0);
  CHECK(errors[1].track == 2);
  CHECK(errors[1].relative == Approx(0.7 / 9.8));
  CHECK(errors[2].track == 3);
  CHECK(errors[2].relative == Approx(0.1));
}
