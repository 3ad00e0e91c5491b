#include <petsclog.h>

#include <catch2/catch.hpp>
#include <string>

#include "bodies.h"

using namespace floe;
using namespace floe::testing;

namespace {

/// Of the log so far: a new one's number is the count of those before it.
PetscLogStage stages() {
  static int asked = 0;
  PetscLogStage next = 0;
  petsc::check(PetscLogStageRegister(("count " + std::to_string(asked++)).c_str(), &next));
  return next;
}

/// But for those that count eigenvalues.
int factorisations() {
  PetscLogEvent event = 0;
  PetscLogStage counts = -1;
  petsc::check(PetscLogStageGetId("eigenvalue count", &counts));
  petsc::check(PetscLogEventGetId("MatCholFctrNum", &event));
  int count = 0;
  const PetscLogStage known = stages();
  for (PetscLogStage stage = 0; stage < known; ++stage) {
    PetscEventPerfInfo info;
    petsc::check(PetscLogEventGetPerfInfo(stage, event, &info));
    if (stage != counts) count += info.count;
  }
  return count;
}

/// Of modes, more modes, and derivatives.
int spent(Kind kind, const fem::Conditions& constrained) {
  const Held body(straight(PETSC_COMM_WORLD, 10, 1, {1e4, 1, 1, 0}), kind, constrained);
  const int before = factorisations();
  reduction::ModeSolver solver(body.structure, body.frame, body.holding, body.statics);
  const auto few = solver.solve(2), more = solver.solve(4);
  CHECK(more.omega[1] == Approx(few.omega[1]).epsilon(1e-10));
  reduction::static_derivatives(body.structure, body.statics, more.shapes, reduction::all_pairs(4));
  return factorisations() - before;
}

}  // namespace

TEST_CASE("a held body's stiffness is factored once, for modes and derivatives together") {
  petsc::check(PetscLogDefaultBegin());
  CHECK(spent(Kind::clamped, {0, 1, 2}) == 1);
  CHECK(spent(Kind::pinned, {0, 1, 2}) == 1);   // clamped body, pinned frame
  CHECK(spent(Kind::pinned, {0, 1, 31}) == 1);  // simply supported
  CHECK(spent(Kind::pinned, {0, 1}) == 2);      // a rigid motion is left: the modes need a shift
}

TEST_CASE("options -modes_st_... give the modes a solver of their own") {
  petsc::check(PetscLogDefaultBegin());
  petsc::check(PetscOptionsSetValue(nullptr, "-modes_st_ksp_type", "preonly"));
  CHECK(spent(Kind::clamped, {0, 1, 2}) == 2);
  petsc::check(PetscOptionsClearValue(nullptr, "-modes_st_ksp_type"));
}
