#include "floe/math/rounded.h"

#include <catch2/catch.hpp>
#include <limits>

using floe::math::percent;
using floe::math::rounded;

TEST_CASE("numbers have powers of ten where they are small or very great alone") {
  CHECK(rounded(99.7, 2) == "100");
  CHECK(rounded(27123, 3) == "27100");
  CHECK(rounded(-99999, 3) == "-1e+05");
  CHECK(rounded(1432.7, 6) == "1432.7");
  CHECK(rounded(2.5e-7, 2) == "2.5e-07");
  CHECK(rounded(0, 3) == "0");
  CHECK(rounded(std::numeric_limits<double>::infinity(), 2) == "inf");
  CHECK(rounded(std::numeric_limits<double>::quiet_NaN(), 2) == "nan");
}

TEST_CASE("shares in per cent, and errors beyond all use") {
  CHECK(percent(2.9) == "290 %");
  CHECK(percent(0.0123) == "1.2 %");
  CHECK(percent(0.5, 1) == "50 %");
  CHECK(percent(std::numeric_limits<double>::infinity()) == "beyond 10000 %");
}
