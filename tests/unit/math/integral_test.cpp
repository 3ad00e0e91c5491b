#include "floe/math/integral.h"

#include <catch2/catch.hpp>
#include <cmath>

using floe::math::Integral;

TEST_CASE("integrals from 0 to any time, in any order of asking") {
  const Integral error([](double t) { return std::exp(-t * t); }, 0.3);
  for (const double t : {2., 0.1, -1.3, 0., 5., 0.3, -0.05})
    CHECK(error(t) == Approx(std::sqrt(M_PI) / 2 * std::erf(t)).epsilon(1e-13).margin(1e-15));
  const Integral again([](double t) { return std::exp(-t * t); }, 0.3);
  CHECK(again(5.) == error(5.));
}

TEST_CASE("integrals pass corners and jumps") {
  const Integral ramp([](double t) { return t < 0.37 ? 0 : t < 1.11 ? 2 * (t - 0.37) : 5; }, 0.25);
  CHECK(ramp(0.37) == Approx(0).margin(1e-13));
  CHECK(ramp(1.0) == Approx(0.63 * 0.63).epsilon(1e-11));
  CHECK(ramp(3.0) == Approx(0.74 * 0.74 + 5 * 1.89).epsilon(1e-10));
}
