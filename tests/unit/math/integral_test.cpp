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

TEST_CASE("integrals from break to break see what no point of a rule sees") {
  const auto pulse = [](double t) { return t > 0.1 && t < 0.1002 ? 10. : 0.; };
  CHECK(Integral(pulse, 16.)(5.) == 0);  // without the breaks
  const Integral seen(pulse, 16., {0.1, 0.1002});
  CHECK(seen(0.1) == 0);
  CHECK(seen(0.1001) == Approx(1e-3).epsilon(1e-12));
  CHECK(seen(5.) == Approx(2e-3).epsilon(1e-12));
  CHECK(seen(40.) == Approx(2e-3).epsilon(1e-12));
}

TEST_CASE("integrals of round-off end") {
  int calls = 0;
  const auto nothing = [&](double t) {
    return ++calls, (std::exp(t) + std::sin(9 * t)) - std::sin(9 * t) - std::exp(t);
  };
  CHECK(Integral(nothing, 0.5)(1.) == Approx(0).margin(1e-15));
  CHECK(calls < 100'000);
}
