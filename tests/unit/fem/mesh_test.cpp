#include "floe/fem/mesh.h"

#include <algorithm>
#include <catch2/catch.hpp>

#include "structures.h"

using namespace floe;
using Eigen::Vector3d;

namespace {

/// Three members that meet at (1, 0), the second drawn towards it.
const fem::Segments branched{{{0, 0, 0}, {1, 0, 0}, {1, 2, 0}, {3, 0, 0}}, {{0, 1}, {2, 1}, {1, 3}}, {2, 4, 3}};

/// Positions of all nodes, gathered from their owners.
std::vector<Vector3d> all_positions(const fem::Mesh& mesh) {
  std::vector<double> sum(3 * static_cast<std::size_t>(mesh.node_count), 0.0);
  for (PetscInt i = 0; i < mesh.owned_nodes; ++i)
    for (int d = 0; d < 3; ++d) sum[3 * (mesh.first_node + i) + d] += mesh.positions[i][d];
  MPI_Allreduce(MPI_IN_PLACE, sum.data(), static_cast<int>(sum.size()), MPI_DOUBLE, MPI_SUM, mesh.comm);
  std::vector<Vector3d> all;
  for (std::size_t i = 0; i < sum.size(); i += 3) all.emplace_back(sum[i], sum[i + 1], sum[i + 2]);
  return all;
}

/// How often each (node, node, part) occurs, over all ranks.
std::vector<int> all_cells(const fem::Mesh& mesh) {
  const PetscInt n = mesh.node_count;
  std::vector<int> count(static_cast<std::size_t>(n * n * 3), 0);
  for (const auto& cell : mesh.cells)
    ++count[(mesh.global_node(cell.place[0]) * n + mesh.global_node(cell.place[1])) * 3 + cell.part];
  MPI_Allreduce(MPI_IN_PLACE, count.data(), static_cast<int>(count.size()), MPI_INT, MPI_SUM, mesh.comm);
  return count;
}

}  // namespace

TEST_CASE("nodes are numbered along the segments, points where they are met first") {
  const fem::Mesh mesh = fem::mesh_of(PETSC_COMM_WORLD, branched);
  REQUIRE(mesh.node_count == 10);
  REQUIRE(mesh.cell_count == 9);
  // the second segment meets its first end (1, 2) before its inner nodes
  const std::vector<Vector3d> expected{{0, 0, 0}, {0.5, 0, 0}, {1, 0, 0},          {1, 2, 0},          {1, 1.5, 0},
                                       {1, 1, 0}, {1, 0.5, 0}, {1 + 2. / 3, 0, 0}, {1 + 4. / 3, 0, 0}, {3, 0, 0}};
  const std::vector<Vector3d> found = all_positions(mesh);
  for (std::size_t i = 0; i < expected.size(); ++i) CHECK((found[i] - expected[i]).norm() < 1e-15);
}

TEST_CASE("nodes and cells do not depend on the number of ranks; each cell has one owner") {
  const fem::Mesh mesh = fem::mesh_of(PETSC_COMM_WORLD, branched), alone = fem::mesh_of(PETSC_COMM_SELF, branched);
  CHECK(all_cells(mesh) == all_cells(alone));
  const auto found = all_positions(mesh), expected = all_positions(alone);
  for (std::size_t i = 0; i < expected.size(); ++i) CHECK(found[i] == expected[i]);
  CHECK(std::is_sorted(mesh.foreign.begin(), mesh.foreign.end()));
  PetscInt owned = mesh.owned_nodes;
  MPI_Allreduce(MPI_IN_PLACE, &owned, 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD);
  CHECK(owned == 10);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)  // copies of foreign nodes too
    CHECK(mesh.positions[i] == expected[mesh.global_node(static_cast<int>(i))]);
}

TEST_CASE("a mesh of one element on more ranks than nodes") {
  const fem::Mesh mesh = fem::mesh_of(PETSC_COMM_WORLD, {{{0, 0, 0}, {2, 0, 0}}, {{0, 1}}, {1}});
  CHECK(mesh.node_count == 2);
  CHECK(fem::nearest_node(mesh, {1.9, 0, 0}).node == 1);
}

TEST_CASE("nearest node: the same on all ranks, the lowest of equally near ones") {
  const fem::Mesh mesh = fem::mesh_of(PETSC_COMM_WORLD, branched);
  const fem::NearestNode found = fem::nearest_node(mesh, {1.1, 1.0, 0});
  CHECK(found.position == Vector3d(1, 1, 0));
  CHECK(found.distance == Approx(0.1).epsilon(1e-14));
  CHECK(fem::nearest_node(mesh, {0.25, 0, 0}).node == 0);
  CHECK(fem::nearest_node(mesh, {0.75, 0, 0}).node == 1);
  CHECK(fem::nearest_node(mesh, {99, 0, 0}).node == 9);
  PetscInt lowest = found.node, highest = found.node;
  MPI_Allreduce(MPI_IN_PLACE, &lowest, 1, MPIU_INT, MPI_MIN, PETSC_COMM_WORLD);
  MPI_Allreduce(MPI_IN_PLACE, &highest, 1, MPIU_INT, MPI_MAX, PETSC_COMM_WORLD);
  CHECK(lowest == highest);
}

TEST_CASE("a mesh in the axes of a frame: distances stay, the origin and the axis go where they should") {
  fem::Mesh mesh = fem::mesh_of(PETSC_COMM_WORLD, branched);
  const double angle = 0.7;
  const Eigen::Matrix3d rotation = Eigen::AngleAxisd(angle, Vector3d::UnitZ()).toRotationMatrix();
  const Vector3d origin(1, 2, 0);
  const auto before = all_positions(mesh);
  fem::express_in_frame(mesh, origin, rotation);
  const auto after = all_positions(mesh);
  for (std::size_t i = 0; i < before.size(); ++i) CHECK((origin + rotation * after[i] - before[i]).norm() < 1e-14);
  CHECK(fem::nearest_node(mesh, Vector3d::Zero()).distance < 1e-15);
}
