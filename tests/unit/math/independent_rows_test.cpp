#include "floe/math/independent_rows.h"

#include <catch2/catch.hpp>

using Eigen::Index;
using Eigen::MatrixXd;
using floe::math::independent_rows;
using floe::math::undetermined_rows;
using Rows = std::vector<Index>;

TEST_CASE("rows that depend on others, and multipliers that are not determined for that") {
  MatrixXd G(4, 3);
  G << 1, 0, 0, 0, 1, 0, 0, 2, 0, 0, 0, 1;
  const Rows kept = independent_rows(G);
  CHECK(kept == Rows{0, 1, 3});
  CHECK(undetermined_rows(G, kept) == Rows{1, 2});  // the second and third hold the same
  G.row(2) << 1, 1, 0;
  CHECK(undetermined_rows(G, independent_rows(G)) == Rows{0, 1, 2});
}

TEST_CASE("rows without anything that they hold are not determined, and alone") {
  MatrixXd G = MatrixXd::Zero(2, 3);
  CHECK(independent_rows(G, 1e-3).empty());
  CHECK(undetermined_rows(G, {}) == Rows{0, 1});
  G(0, 1) = 1;
  CHECK(undetermined_rows(G, {0}) == Rows{1});
  CHECK(undetermined_rows(MatrixXd::Identity(2, 2), {0, 1}).empty());
}
