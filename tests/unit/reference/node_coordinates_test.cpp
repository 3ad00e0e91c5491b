#include <catch2/catch.hpp>

#include "floe/reference/full_order.h"
#include "structures.h"

using namespace floe;

namespace {

fem::Mesh mesh_of(PetscInt elements) {
  return fem::mesh_of(PETSC_COMM_WORLD, {{{0, 0, 0}, {1, 0, 0}}, {{0, 1}}, {elements}});
}

bool last_rank() { return testing::this_rank() == testing::ranks() - 1; }

}  // namespace

TEST_CASE("nodes are numbered alike on any number of ranks; the last rank sees the visited ones besides") {
  const fem::Mesh mesh = mesh_of(9);
  dynamics::Coordinates c(PETSC_COMM_WORLD);
  const int frame = c.add_shared(3);
  const reference::NodeCoordinates nodes(c, mesh, {0, 9, 4, 4});
  c.number();
  CHECK(c.global_size() == 33);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const PetscInt node = mesh.global_node(static_cast<int>(i));
    CHECK(nodes.of_local_node(static_cast<int>(i)) == nodes.of_node(node));
    for (int d = 0; d < 3; ++d) CHECK(c.global()[nodes.of_node(node) + d] == 3 * node + d);
  }
  for (int d = 0; d < 3; ++d) CHECK(c.global()[frame + d] == 30 + d);
  if (last_rank())
    for (PetscInt node : {0, 4, 9}) CHECK(c.global()[nodes.of_node(node)] == 3 * node);
  else
    CHECK_THROWS_AS(nodes.of_node(9), std::out_of_range);
}

TEST_CASE("two bodies and their multipliers in one layout: every unknown has one owner") {
  const fem::Mesh one = mesh_of(3), other = mesh_of(5);
  dynamics::Coordinates c(PETSC_COMM_WORLD);
  c.add_shared(3);
  const reference::NodeCoordinates first(c, one, {});
  c.add_shared(3);
  const reference::NodeCoordinates second(c, other, {0});
  c.add_shared(2, true);
  c.number();
  REQUIRE(c.global_size() == 12 + 18 + 8);
  CHECK(c.multiplier_count() == 2);
  PetscInt total = c.owned_size();
  MPI_Allreduce(MPI_IN_PLACE, &total, 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD);
  CHECK(total == 38);
  CHECK(c.owned_multipliers() == (last_rank() ? std::vector<PetscInt>{36, 37} : std::vector<PetscInt>{}));
  // what each rank calls node n of a body has one global number on all ranks
  const auto agreed = [&](const reference::NodeCoordinates& nodes, const fem::Mesh& mesh) {
    std::vector<PetscInt> low(static_cast<std::size_t>(mesh.node_count), PETSC_MAX_INT), high(low.size(), -1);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
      const PetscInt node = mesh.global_node(static_cast<int>(i));
      low[node] = high[node] = c.global()[nodes.of_node(node)];
    }
    MPI_Allreduce(MPI_IN_PLACE, low.data(), static_cast<int>(low.size()), MPIU_INT, MPI_MIN, PETSC_COMM_WORLD);
    MPI_Allreduce(MPI_IN_PLACE, high.data(), static_cast<int>(high.size()), MPIU_INT, MPI_MAX, PETSC_COMM_WORLD);
    return low == high;
  };
  CHECK(agreed(first, one));
  CHECK(agreed(second, other));
}
