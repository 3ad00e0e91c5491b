#include "floe/petsc/error.h"

#include <catch2/catch.hpp>

#include "structures.h"

using namespace floe;
using Catch::Matchers::Contains;
using petsc::agree;

namespace {

struct Other : std::logic_error {
  using std::logic_error::logic_error;
};

}  // namespace

TEST_CASE("check throws PETSc's code and message in one line, with the functions that failed and that was called") {
  CHECK_NOTHROW(petsc::check(0));
  petsc::VecHandle vec;
  petsc::check(VecCreateSeq(PETSC_COMM_SELF, 3, vec.out()));
  try {
    petsc::check(VecSetType(vec, "no such type"));
    FAIL("no exception");
  } catch (const petsc::Error& error) {
    CHECK(error.code() == PETSC_ERR_ARG_UNKNOWN_TYPE);
    CHECK_THAT(error.what(), Contains("no such type") && Contains("(in VecSetType)"));
    CHECK_THAT(error.what(), !Contains("\n") && !Contains(".c"));
  }
  CHECK_THROWS_WITH(petsc::check(PETSC_ERR_MEM), Contains("55") && !Contains("no such type"));  // nothing is left over
}

TEST_CASE("a singular matrix is named so") {
  petsc::MatHandle A;
  petsc::check(MatCreateSeqDense(PETSC_COMM_SELF, 2, 2, nullptr, A.out()));
  petsc::check(MatAssemblyBegin(A, MAT_FINAL_ASSEMBLY));
  petsc::check(MatAssemblyEnd(A, MAT_FINAL_ASSEMBLY));
  CHECK_THROWS_WITH(petsc::check(MatLUFactor(A, nullptr, nullptr, nullptr)),
                    Contains("a matrix is singular") && !Contains("http"));
}

TEST_CASE("agree returns on all ranks when all is well") {
  int done = 0;
  CHECK_NOTHROW(agree(PETSC_COMM_WORLD, [&] { ++done; }));
  CHECK(done == 1);
}

TEST_CASE("agree throws on every rank what one rank threw, of the same kind") {
  for (int failing = 0; failing < testing::ranks(); ++failing) {
    const bool mine = testing::this_rank() == failing;
    const std::string text = "fault of rank " + std::to_string(failing);
    CHECK_THROWS_AS(agree(PETSC_COMM_WORLD,
                          [&] {
                            if (mine) throw InputError(text);
                          }),
                    InputError);
    CHECK_THROWS_WITH(agree(PETSC_COMM_WORLD,
                            [&] {
                              if (mine) throw InputError(text);
                            }),
                      text);
    CHECK_THROWS_AS(agree(PETSC_COMM_WORLD,
                          [&] {
                            if (mine) throw RunError(text);
                          }),
                    RunError);
    CHECK_THROWS_WITH(agree(PETSC_COMM_WORLD,
                            [&] {
                              if (mine) throw Other(text);
                            }),
                      text);
    CHECK_THROWS_AS(agree(PETSC_COMM_WORLD,
                          [&] {
                            if (mine) throw Other(text);
                          }),
                    RunError);
  }
}

TEST_CASE("agree tells the fault of the lowest failing rank") {
  const int lowest = testing::ranks() > 2 ? 1 : 0;
  const auto work = [&] {
    if (testing::this_rank() > lowest) throw RunError("later");
    if (testing::this_rank() == lowest) throw InputError(std::vector<std::string>{"first", "second"});
  };
  CHECK_THROWS_AS(agree(PETSC_COMM_WORLD, work), InputError);
  CHECK_THROWS_WITH(agree(PETSC_COMM_WORLD, work), "first\nsecond");
}

TEST_CASE("agree_if_parallel lets a rank that works for itself throw alone") {
  const bool mine = testing::this_rank() == 0;
  bool thrown = false;
  try {
    petsc::agree_if_parallel(PETSC_COMM_WORLD, true, [&] {
      if (mine) throw Other("alone");
    });
  } catch (const Other&) {  // not rotated into a RunError
    thrown = true;
  }
  CHECK(thrown == mine);
  CHECK_THROWS_AS(petsc::agree_if_parallel(PETSC_COMM_WORLD, false,
                                           [&] {
                                             if (mine) throw Other("all");
                                           }),
                  RunError);
}

TEST_CASE("Guard carries the first exception across a C frame, unchanged") {
  petsc::Guard guard;
  int calls = 0;
  CHECK(guard.run([&] { ++calls; }) == 0);
  CHECK_NOTHROW(guard.check(0));
  const PetscErrorCode code = guard.run([] { throw Other("first"); });
  CHECK(code != 0);
  CHECK(guard.run([] { throw RunError("second"); }) != 0);
  CHECK_THROWS_AS(guard.check(code), Other);
  CHECK_NOTHROW(guard.check(0));  // thrown once
  CHECK_THROWS_AS(guard.check(PETSC_ERR_MEM), petsc::Error);
  CHECK(calls == 1);
}
