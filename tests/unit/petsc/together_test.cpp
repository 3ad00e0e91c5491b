#include "floe/petsc/together.h"

#include <catch2/catch.hpp>
#include <new>

#include "floe/error.h"
#include "structures.h"

using namespace floe;
using petsc::failed_together;

TEST_CASE("failed_together: work that succeeds, or fails on all ranks, is told alike on all of them") {
  CHECK(failed_together(PETSC_COMM_WORLD, [] {}) == "");
  CHECK(failed_together(PETSC_COMM_WORLD, [] { throw RunError("no factor"); }) == "no factor");
  CHECK(failed_together(PETSC_COMM_WORLD, [] { throw InputError("no words"); }) == "no words");
  CHECK(failed_together(PETSC_COMM_WORLD, [] { throw std::bad_alloc(); }) == std::bad_alloc().what());
}

TEST_CASE("failed_together: what one rank fails of is told on all of them, if they are through") {
  for (int failing = 0; failing < testing::ranks(); ++failing)
    CHECK(failed_together(PETSC_COMM_WORLD, [&] {
            if (testing::this_rank() == failing) throw std::bad_alloc();
          }) == std::bad_alloc().what());
}
