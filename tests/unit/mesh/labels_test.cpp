#include "floe/mesh/labels.h"

#include "mesh_files.h"

using namespace floe;

TEST_CASE("labels are found whatever they are") {
  const int rank = testing::this_rank(), ranks = testing::ranks();
  for (const long long step : {1LL, -3LL, 1LL << 55}) {
    std::vector<long long> mine, all;
    for (int i = 0; i < 5 * ranks; ++i) all.push_back((i + 1) * step);
    mine.assign(all.begin() + 5 * rank, all.begin() + 5 * rank + 5);
    const mesh::LabelDirectory directory(PETSC_COMM_WORLD, mine);
    CHECK(directory.count() == 5 * ranks);
    const auto found = directory.find(all);
    for (int i = 0; i < 5 * ranks; ++i) CHECK(found[i] == i);
    CHECK(directory.find({0, 5 * ranks * step + 1, -1LL}) == std::vector<PetscInt>{-1, -1, -1});
    CHECK(directory.repeated(mine).empty());
  }
}

TEST_CASE("labels that are there twice are found where they are the second") {
  const std::vector<long long> mine{100 + testing::this_rank(), 7};
  const mesh::LabelDirectory directory(PETSC_COMM_WORLD, mine);
  const auto expected = testing::this_rank() ? std::vector<std::size_t>{1} : std::vector<std::size_t>{};
  CHECK(directory.repeated(mine) == expected);
  CHECK(directory.find({7}) == std::vector<PetscInt>{1});
}

TEST_CASE("a translation knows its keys, close or sparse") {
  for (const long long step : {1LL, 1LL << 60}) {
    const mesh::Translation keys({3 * step, -step, 3 * step, 0});
    CHECK(keys.keys() == std::vector<long long>{-step, 0, 3 * step});
    CHECK(keys.position(3 * step) == 2);
    CHECK(keys.position(2 * step) == -1);
    CHECK(keys.position(4 * step) == -1);
  }
  CHECK(mesh::Translation({}).position(0) == -1);
}
