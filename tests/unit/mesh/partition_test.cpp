#include "floe/mesh/partition.h"

#include "floe/mesh/gmsh.h"
#include "gmsh_text.h"
#include "mesh_files.h"

using namespace floe;

namespace {

// A grid whose nodes stand in the file in an order that has nothing to do with where they are.
mesh::RawMesh shuffled_grid(int n) {
  auto raw = mesh::read_gmsh(PETSC_COMM_WORLD, testing::written("grid.msh", testing::gmsh_grid(n, n, true))).mesh;
  constexpr long long stride = 7919;  // a prime that does not divide the number of nodes
  for (auto& cell : raw.cells)
    for (int k = 0; k < 3; ++k) cell.nodes[k] = static_cast<PetscInt>(cell.nodes[k] * stride % raw.node_count);
  return raw;
}

struct Option {
  explicit Option(const char* value) { petsc::check(PetscOptionsSetValue(nullptr, name, value)); }
  ~Option() { PetscOptionsClearValue(nullptr, name); }
  static constexpr const char* name = "-mesh_mat_partitioning_type";
};

}  // namespace

TEST_CASE("METIS gives parts of one size and cuts few edges") {
  const auto raw = shuffled_grid(40);
  const auto parts = mesh::partition(raw);
  std::vector<PetscInt> sizes(testing::ranks(), 0);
  for (const int part : parts) ++sizes.at(part);
  MPI_Allreduce(MPI_IN_PLACE, sizes.data(), testing::ranks(), MPIU_INT, MPI_SUM, PETSC_COMM_WORLD);
  const double mean = static_cast<double>(raw.node_count) / testing::ranks();
  for (const auto size : sizes) CHECK(std::abs(size - mean) < 0.05 * mean);
  const auto cut = mesh::edge_cut(raw, parts);
  const std::vector<int> stay(parts.size(), testing::this_rank());
  if (testing::ranks() > 1) {
    CHECK(cut < mesh::edge_cut(raw, stay) / 4);
    CHECK(cut < 4 * 3 * 41 * (testing::ranks() - 1) / 2);  // straight cuts: up to 3 edges for each node of a side
  } else {
    CHECK(cut == 0);
  }
}

TEST_CASE("the partitioner is an option") {
  const auto raw = shuffled_grid(12);
  {
    const Option current("current");
    CHECK(mesh::partition(raw) == std::vector<int>(raw.positions.size(), testing::this_rank()));
  }
  {
    const Option scotch("ptscotch");
    const std::vector<int> stay(raw.positions.size(), testing::this_rank());
    if (sizeof(PetscInt) == 4 || testing::ranks() == 1)
      CHECK(mesh::edge_cut(raw, mesh::partition(raw)) <= mesh::edge_cut(raw, stay));
    else  // PETSc of 64-bit indices comes with a PT-Scotch of 32
      CHECK_THROWS_WITH(mesh::partition(raw), Catch::Contains("has integers of 32 bits, PETSc of 64"));
  }
  if (testing::ranks() > 1) {
    const Option unknown("no such type");
    CHECK_THROWS_AS(mesh::partition(raw), InputError);
  }
}

TEST_CASE("a mesh of fewer nodes than ranks is partitioned") {
  const auto raw = mesh::read_gmsh(PETSC_COMM_WORLD, testing::written("one.msh", testing::gmsh_grid(1, 1, true))).mesh;
  for (const int part : mesh::partition(raw)) CHECK((part >= 0 && part < testing::ranks()));
}
