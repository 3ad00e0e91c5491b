#include "../../../src/app/estimate_words.h"

#include <catch2/catch.hpp>
#include <limits>

using namespace floe;

TEST_CASE("an accuracy that is missed by little is told with the digits that show it") {
  CHECK(app::missed_words(0.01, 0.0103) ==
        "the best model found has an estimated error of 1.03 % (limit 1 %, the accuracy requested)");
  CHECK(app::missed_words(0.01, 0.05) ==
        "the best model found has an estimated error of 5 % (limit 1 %, the accuracy requested)");
}

TEST_CASE("an estimate is told in per cent, or why there is none, or that it is beyond all use") {
  assess::Estimate estimate;
  CHECK(app::estimate_words(estimate) == "No estimate of the error: it was not asked for\n");
  CHECK(app::estimate_words(estimate, true) == "No estimate of the reduction error: it was not asked for\n");
  estimate.none.clear();
  estimate.deformation = 0.0123, estimate.seconds = 0.5, estimate.notes = {"sampled"};
  CHECK(app::estimate_words(estimate) ==
        "estimated error 1.2 % (deformations, relative to the full-order model of the same mesh; 0.5 s)\n"
        "Note (estimate): sampled\n");
  estimate.deformation = std::numeric_limits<double>::infinity();
  CHECK_THAT(app::estimate_words(estimate), Catch::Contains("above 10000 %"));
  estimate.by = "formulation nlffr, same mesh";
  CHECK(app::estimate_words(estimate) ==
        "reduction: formulation nlffr, same mesh (computed in 0.5 s)\nNote (estimate): sampled\n");
}
