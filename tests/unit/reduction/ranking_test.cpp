#include "floe/reduction/ranking.h"

#include <catch2/catch.hpp>

#include "bodies.h"

using namespace floe;
using namespace floe::testing;

namespace {

/// Fields with given coordinates (columns of C) in M-orthonormal modes.
reduction::Columns combinations(const fem::Structure& s, const reduction::Columns& modes, const Eigen::MatrixXd& C) {
  reduction::Columns fields;
  for (Eigen::Index c = 0; c < C.cols(); ++c) {
    fields.push_back(fem::field(s));
    for (Eigen::Index i = 0; i < C.rows(); ++i) petsc::check(VecAXPY(fields.back(), C(i, c), modes[i]));
  }
  return fields;
}

}  // namespace

// Hand-made coordinates: what counts is the part that is new.
TEST_CASE("ranking takes what adds most, and never what adds nothing") {
  const Held body(straight(PETSC_COMM_WORLD, 8, 1, {1e4, 1, 1, 0}), Kind::clamped, {0, 1, 2});
  const auto modes = reduction::vibration_modes(body.structure, body.frame, body.holding, body.statics, 4);
  Eigen::MatrixXd given(4, 1), candidates(4, 4);
  given << 1, 0, 0, 0;
  candidates << 9, 0, 0, 5,  // along `given`
      .1, 1, 1, 0,           //
      0, 0, .5, 0,           //
      0, 0, 0, 0;
  const auto ranked =
      reduction::rank(body.structure, combinations(body.structure, modes.shapes, given),
                      combinations(body.structure, modes.shapes, candidates), {1, 1.05, 1, 100}, 4, 1e-7);
  // 2: |(1, .5)| = 1.118. Then 1 without its part along 2: sqrt(1 - 1/1.25) 1.05 = 0.4696, 0: 0.0447. Nothing is new in
  // the fourth, and only two dimensions are.
  REQUIRE(ranked.size() == 2);
  CHECK(ranked[0].candidate == 2);
  CHECK(ranked[0].weight == 1);
  CHECK(ranked[1].candidate == 1);
  CHECK(ranked[1].weight == Approx(1.05 * std::sqrt(1 - 1 / 1.25) / std::sqrt(1.25)).epsilon(1e-8));
}
