#include "../../../src/app/sweep.h"

#include <catch2/catch.hpp>

using namespace floe::app;

TEST_CASE("warnings that differ in their numbers alone are one") {
  CHECK(without_numbers("body f: slopes to 2.7 in its frame, beyond 0.5: err by 8e+01 % (frames: 2)") ==
        without_numbers("body f: slopes to 0.55 in its frame, beyond 0.5: err by .6 % (frames: 2)"));
  CHECK(without_numbers("(limit 2 %)") == "(limit # %)");
  CHECK(without_numbers("body beam2: slopes to 1") != without_numbers("body beam3: slopes to 1"));
  CHECK(without_numbers("body left.1, mode 3") != without_numbers("body left.2, mode 3"));
}

TEST_CASE("a warning of a sweep names the first member and counts the others") {
  SweepWarning warning{"too far", {7}, {{"F", 0.1}, {"loads.tip.force[2]", -20}}};
  CHECK(words_of(warning) == "too far (member 7: F = 0.1, loads.tip.force[2] = -20)");
  warning.members = {7, 9, 12};
  CHECK(words_of(warning) == "too far (member 7: F = 0.1, loads.tip.force[2] = -20; 2 more likewise)");
}
