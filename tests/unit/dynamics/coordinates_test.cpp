#include "floe/dynamics/coordinates.h"

#include <catch2/catch.hpp>

using floe::dynamics::Coordinates;

TEST_CASE("local indices count in the order added; globally distributed blocks come before shared ones") {
  Coordinates c(PETSC_COMM_SELF);
  CHECK(c.add_shared(3) == 0);
  CHECK(c.add_distributed(4, {}) == 3);
  CHECK(c.add_shared(2, true) == 7);
  CHECK(c.add_distributed(1, {}) == 9);
  CHECK(c.add_shared(1) == 10);
  c.number();
  CHECK(c.local_size() == 11);
  CHECK(c.owned_size() == 11);
  CHECK(c.global_size() == 11);
  CHECK(c.global() == std::vector<PetscInt>{5, 6, 7, 0, 1, 2, 3, 8, 9, 4, 10});
  CHECK(c.multiplier() == std::vector<char>{0, 0, 0, 0, 0, 0, 0, 1, 1, 0, 0});
  CHECK(c.owned_multipliers() == std::vector<PetscInt>{8, 9});
  CHECK(c.multiplier_count() == 2);
}

TEST_CASE("shared blocks alone keep their order") {
  Coordinates c(PETSC_COMM_SELF);
  c.add_shared(3);
  c.add_shared(0);
  c.add_shared(2);
  c.number();
  CHECK(c.global() == std::vector<PetscInt>{0, 1, 2, 3, 4});
  CHECK(c.owned_multipliers().empty());
  CHECK(c.multiplier_count() == 0);
}
