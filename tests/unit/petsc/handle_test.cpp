#include "floe/petsc/handle.h"

#include <catch2/catch.hpp>
#include <type_traits>

#include "structures.h"

using namespace floe;
using petsc::VecHandle;

namespace {

/// A vector with a second reference, so that its count can be read after a handle has let go.
Vec watched() {
  Vec vec = nullptr;
  petsc::check(VecCreateMPI(PETSC_COMM_WORLD, 2, PETSC_DETERMINE, &vec));
  petsc::check(PetscObjectReference(reinterpret_cast<PetscObject>(vec)));
  return vec;
}

PetscInt references(Vec vec) {
  PetscInt count = 0;
  petsc::check(PetscObjectGetReference(reinterpret_cast<PetscObject>(vec), &count));
  return count;
}

static_assert(!std::is_copy_constructible_v<VecHandle> && !std::is_copy_assignable_v<VecHandle>);
static_assert(std::is_nothrow_move_constructible_v<VecHandle> && std::is_nothrow_move_assignable_v<VecHandle>);

}  // namespace

TEST_CASE("a handle destroys its object once, at the end of its life") {
  Vec vec = watched();
  {
    VecHandle outer;
    {
      VecHandle inner(vec);
      CHECK(inner.get() == vec);
      outer = std::move(inner);
      CHECK(inner.get() == nullptr);
    }
    CHECK(references(vec) == 2);
    const VecHandle moved = std::move(outer);
    CHECK(outer.get() == nullptr);
    CHECK(static_cast<Vec>(moved) == vec);
  }
  CHECK(references(vec) == 1);
  petsc::check(VecDestroy(&vec));
}

TEST_CASE("out() destroys what was held before") {
  Vec vec = watched();
  VecHandle handle(vec);
  CHECK(*handle.out() == nullptr);
  CHECK(references(vec) == 1);
  petsc::check(VecDuplicate(vec, handle.out()));
  CHECK(handle.get() != vec);
  petsc::check(VecDestroy(&vec));
}

TEST_CASE("Values views this rank's entries by their global numbers") {
  VecHandle vec;
  petsc::check(VecCreateMPI(PETSC_COMM_WORLD, 3, PETSC_DETERMINE, vec.out()));
  {
    petsc::Values values(vec);
    CHECK(values.first == 3 * testing::this_rank());
    CHECK(values.end == values.first + 3);
    for (PetscInt i = values.first; i < values.end; ++i) values[i] = double(i * i);
  }
  const Eigen::VectorXd all = testing::everywhere(vec);
  REQUIRE(all.size() == 3 * testing::ranks());
  for (Eigen::Index i = 0; i < all.size(); ++i) CHECK(all[i] == double(i * i));
}
