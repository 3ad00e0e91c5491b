#include <catch2/catch.hpp>
#include <set>
#include <tuple>

#include "spatial_structures.h"

using namespace floe;
using Eigen::Vector3d;
using testing::Spread;

namespace {

using NamedCell = std::array<PetscInt, 6>;  // kind, part, nodes by original numbers

/// All values of all ranks of the mesh. Collective.
template <class Value>
std::vector<Value> of_all(const std::vector<Value>& mine) {
  int bytes = static_cast<int>(mine.size() * sizeof(Value));
  std::vector<int> counts(testing::ranks()), starts(testing::ranks() + 1, 0);
  MPI_Allgather(&bytes, 1, MPI_INT, counts.data(), 1, MPI_INT, PETSC_COMM_WORLD);
  std::partial_sum(counts.begin(), counts.end(), starts.begin() + 1);
  std::vector<Value> all(starts.back() / sizeof(Value));
  MPI_Allgatherv(mine.data(), bytes, MPI_BYTE, all.data(), counts.data(), starts.data(), MPI_BYTE, PETSC_COMM_WORLD);
  return all;
}

std::vector<NamedCell> cells_of(const fem::Mesh& mesh) {
  std::vector<NamedCell> cells;
  for (const auto& cell : mesh.cells) {
    NamedCell named{static_cast<PetscInt>(cell.kind), cell.part, -1, -1, -1, -1};
    for (std::size_t i = 0; i < cell.nodes().size(); ++i) named[2 + i] = mesh.original_node(cell.nodes()[i]);
    cells.push_back(named);
  }
  return cells;
}

fem::Mesh mixed(MPI_Comm comm, Spread spread) {
  const mesh::RawMesh raw = testing::mixed_mesh(comm);
  return fem::mesh_of(raw, testing::ranks_of(raw, spread));
}

/// Original numbers in the order of the global ones. Collective.
std::vector<PetscInt> originals_of(const fem::Mesh& mesh) {
  return of_all(std::vector<PetscInt>(mesh.original.begin(), mesh.original.begin() + mesh.owned_nodes));
}

}  // namespace

TEST_CASE("a distributed mesh has every node once, on the rank that was named, with its position and original number") {
  const Spread spread = GENERATE(Spread::metis, Spread::shuffled, Spread::reversed, Spread::last);
  const mesh::RawMesh raw = testing::mixed_mesh(PETSC_COMM_WORLD), whole = testing::mixed_mesh(PETSC_COMM_SELF);
  const std::vector<int> ranks = testing::ranks_of(raw, spread), named = of_all(ranks);
  const fem::Mesh mesh = fem::mesh_of(raw, ranks);
  CHECK((mesh.node_count == 21 && mesh.cell_count == 12 + 4 + 3 + 1 && mesh.dimension == 3));
  std::vector<PetscInt> originals = originals_of(mesh);
  REQUIRE(originals.size() == 21);
  CHECK(mesh.first_node + mesh.owned_nodes <= 21);
  for (PetscInt i = 0; i < mesh.owned_nodes; ++i) {
    CHECK(originals[mesh.first_node + i] == mesh.original[i]);
    CHECK(named[mesh.original[i]] == testing::this_rank());
    if (i > 0) CHECK(mesh.original[i] > mesh.original[i - 1]);
  }
  REQUIRE(mesh.original.size() == mesh.positions.size());
  REQUIRE(mesh.positions.size() == mesh.owned_nodes + mesh.foreign.size());
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {  // copies of foreign nodes too
    CHECK(mesh.positions[i] == whole.positions[mesh.original[i]]);
    CHECK(originals[mesh.global_node(static_cast<int>(i))] == mesh.original[i]);
  }
  std::sort(originals.begin(), originals.end());
  for (PetscInt i = 0; i < 21; ++i) CHECK(originals[i] == i);
}

TEST_CASE(
    "a distributed mesh has every cell once, with its first node's rank; foreign nodes are those that cells touch") {
  const Spread spread = GENERATE(Spread::metis, Spread::shuffled, Spread::reversed, Spread::last);
  const fem::Mesh mesh = mixed(PETSC_COMM_WORLD, spread);
  const mesh::RawMesh whole = testing::mixed_mesh(PETSC_COMM_SELF);
  std::vector<NamedCell> expected, found = of_all(cells_of(mesh));
  for (const auto& cell : whole.cells)
    expected.push_back(
        {static_cast<PetscInt>(cell.kind), cell.part, cell.nodes[0], cell.nodes[1], cell.nodes[2], cell.nodes[3]});
  std::sort(expected.begin(), expected.end());
  std::sort(found.begin(), found.end());
  CHECK(found == expected);
  std::set<int> touched;
  for (const auto& cell : mesh.cells) {
    CHECK(cell.place[0] < mesh.owned_nodes);
    touched.insert(cell.nodes().begin(), cell.nodes().end());
  }
  for (std::size_t i = 0; i < mesh.foreign.size(); ++i) {
    const PetscInt node = mesh.foreign[i];
    CHECK((node < mesh.first_node || node >= mesh.first_node + mesh.owned_nodes));
    if (i > 0) CHECK(node > mesh.foreign[i - 1]);
    CHECK(touched.count(static_cast<int>(mesh.owned_nodes + i)) == 1);
  }
}

TEST_CASE("the foreign nodes of a rank: those of its cells that other ranks own, each once") {
  const Spread spread = GENERATE(Spread::metis, Spread::shuffled, Spread::reversed, Spread::last);
  const mesh::RawMesh raw = testing::mixed_mesh(PETSC_COMM_WORLD), whole = testing::mixed_mesh(PETSC_COMM_SELF);
  const std::vector<int> ranks = testing::ranks_of(raw, spread), named = of_all(ranks);
  std::set<PetscInt> expected;
  for (const auto& cell : whole.cells)
    for (int i = 0; i < mesh::node_count(cell.kind); ++i)
      if (named[cell.nodes[0]] == testing::this_rank() && named[cell.nodes[i]] != testing::this_rank())
        expected.insert(cell.nodes[i]);
  const fem::Mesh mesh = fem::mesh_of(raw, ranks);
  const std::vector<PetscInt> originals(mesh.original.begin() + mesh.owned_nodes, mesh.original.end());
  CHECK(originals.size() == expected.size());
  CHECK(std::set<PetscInt>(originals.begin(), originals.end()) == expected);
  if (testing::ranks() > 1 && spread == Spread::shuffled)
    CHECK(of_all(std::vector<int>(1, static_cast<int>(expected.size()))) != std::vector<int>(testing::ranks(), 0));
}

TEST_CASE("global nodes: each rank's questions in its own order, repeats too") {
  const Spread spread = GENERATE(Spread::metis, Spread::shuffled, Spread::reversed, Spread::last);
  const fem::Mesh mesh = mixed(PETSC_COMM_WORLD, spread);
  const std::vector<PetscInt> originals = originals_of(mesh);
  std::vector<PetscInt> asked;
  for (PetscInt i = 0; i < 5 * testing::this_rank(); ++i) asked.push_back((7 * i + 3) % 21);  // the first asks nothing
  if (testing::ranks() == 1) asked = {20, 0, 4, 4, 0};
  const std::vector<PetscInt> found = fem::global_nodes(mesh, asked);
  REQUIRE(found.size() == asked.size());
  for (std::size_t i = 0; i < asked.size(); ++i) CHECK(originals[found[i]] == asked[i]);
  const fem::Mesh plane = fem::mesh_of(PETSC_COMM_WORLD, testing::l_shape(2, 1, 3));  // numbers are the original ones
  CHECK(fem::global_nodes(plane, {3, 1, 6}) == std::vector<PetscInt>{3, 1, 6});
}

TEST_CASE("the nearest node does not depend on the partition: of equally near ones the first in the file") {
  const Spread spread = GENERATE(Spread::metis, Spread::shuffled, Spread::reversed, Spread::last);
  const fem::Mesh mesh = mixed(PETSC_COMM_WORLD, spread);
  const std::vector<PetscInt> originals = originals_of(mesh);
  const mesh::RawMesh whole = testing::mixed_mesh(PETSC_COMM_SELF);
  const std::vector<Vector3d> points{{0.5, 0.5, 3}, {0, 0.25, 0},     {0, 0.75, 0},
                                     {9, 0, 0},     {1.7, -0.4, 1.2}, {-1, 0.25, 0}};
  for (const Vector3d& point : points) {
    PetscInt first = 0;
    for (PetscInt i = 1; i < 21; ++i)
      if ((whole.positions[i] - point).norm() < (whole.positions[first] - point).norm()) first = i;
    const fem::NearestNode found = fem::nearest_node(mesh, point);
    CHECK(originals[found.node] == first);
    CHECK(found.position == whole.positions[first]);
    CHECK(found.distance == (whole.positions[first] - point).norm());
  }
}

TEST_CASE("more ranks than nodes: ranks without a node take part") {
  const mesh::RawMesh raw = generate::polyline(PETSC_COMM_WORLD, {{{0, 0, 0}, {0, 0, 2}}, {}, {1}, {}});
  const fem::Mesh mesh = fem::mesh_of(raw, testing::ranks_of(raw, Spread::last));
  CHECK((mesh.node_count == 2 && mesh.cell_count == 1));
  CHECK(mesh.owned_nodes == (testing::this_rank() == testing::ranks() - 1 ? 2 : 0));
  CHECK(fem::nearest_node(mesh, {0, 0, 1.9}).position == Vector3d(0, 0, 2));
}
