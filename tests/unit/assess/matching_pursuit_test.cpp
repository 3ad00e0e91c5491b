#include "../../../src/assess/matching_pursuit.h"

#include <catch2/catch.hpp>

using namespace floe::assess;

TEST_CASE("matching pursuit: what carries most comes first, each besides those before it") {
  // A motion along (3, 0, 0) and (0, 1, 0); candidates: e1 + e2 twice, e3 that carries nothing, e2.
  Directions body;
  body.Y = (Eigen::MatrixXd(3, 2) << 3, 0, 0, 1, 0, 0).finished();
  body.D = (Eigen::MatrixXd(3, 4) << 1, 2, 0, 0, 1, 2, 0, 1, 0, 0, 1, 0).finished();
  body.group = {0, 1, 2, 3};
  const std::vector<Taken> order = matching_pursuit({body}, 4);
  REQUIRE(order.size() == 2);  // the second is the first again, the third carries nothing
  CHECK(order[0].group == 0);
  CHECK(order[0].share == Approx(0.5));  // (3^2 + 1^2)/2 of 10
  CHECK(order[1].group == 3);
  CHECK(order[0].share + order[1].share == Approx(1));
}

TEST_CASE("matching pursuit: groups are taken in all bodies together") {
  Directions one{Eigen::MatrixXd::Identity(2, 2), (Eigen::MatrixXd(2, 1) << 2, 1).finished(), {0, 1}};
  Directions other{Eigen::MatrixXd::Identity(2, 2), (Eigen::MatrixXd(2, 1) << 0, 3).finished(), {0, 1}};
  const std::vector<Taken> order = matching_pursuit({one, other}, 2);
  REQUIRE(order.size() == 2);
  CHECK(order[0].group == 1);
  CHECK(order[0].share == Approx(10.0 / 14));
  // Taken for the other's sake, a direction that is spent here takes nothing away here.
  Directions here{Eigen::MatrixXd(3, 3), Eigen::MatrixXd(3, 1), {0, 1, 2}};
  here.D << 1, 1 + 1e-12, 0, 1e-12, 0, 1, 0, 1e-12, 1;
  here.Y << 3, 1, 1;
  Directions there{Eigen::MatrixXd::Identity(3, 3), (Eigen::MatrixXd(3, 1) << 5, 4, 0.1).finished(), {0, 1, 2}};
  double carried = 0;
  for (const Taken& taken : matching_pursuit({here, there}, 3)) carried += taken.share;
  CHECK(carried == Approx(1));
  CHECK(matching_pursuit({}, 0).empty());
  CHECK(matching_pursuit({{Eigen::MatrixXd::Identity(2, 2), Eigen::MatrixXd::Zero(2, 3), {0, 1}}}, 2).empty());
}
