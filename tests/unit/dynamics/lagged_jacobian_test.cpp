#include <catch2/catch.hpp>

#include "generalized_alpha_problem.h"

using namespace floe::dynamics;
using namespace floe::dynamics::testing;

namespace {

/// A pendulum that swings through a large angle in few steps, its Jacobian kept for `lag` Newton iterations.
Numbers swing(PetscInt lag, double step, TSConvergedReason* reason) {
  const Pendulum pendulum;
  Run run(pendulum.problem(), pendulum.position(2.8), pendulum.velocity(2.8, 0.5), step, 12);
  SNES snes;
  check(TSGetSNES(run.ts, &snes));
  check(SNESSetLagJacobian(snes, lag));
  check(SNESSetLagJacobianPersists(snes, PETSC_TRUE));
  run.solve();
  check(TSGetConvergedReason(run.ts, reason));
  return run.u.back();
}

}  // namespace

// The tension changes sign and the rod turns by half a circle within two steps: a Jacobian from before sends Newton
// away from the solution.
TEST_CASE("generalized-alpha: a step that a kept Jacobian leads astray is made with new ones") {
  const double step = GENERATE(0.1, 0.3, 0.6);
  TSConvergedReason full, kept;
  const Numbers expected = swing(1, step, &full), found = swing(1000, step, &kept);
  REQUIRE(full > 0);
  REQUIRE(kept > 0);
  for (size_t i : {0u, 1u, 2u}) CHECK(found[i] == Approx(expected[i]).epsilon(1e-6).margin(1e-6));
}
