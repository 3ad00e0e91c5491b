#include "floe/mesh/inspect.h"

#include "floe/mesh/gmsh.h"
#include "gmsh_text.h"
#include "mesh_files.h"

using namespace floe;
using Catch::Matchers::Contains;
using mesh::Cell;
using mesh::CellKind;

namespace {

// Each rank takes its share of nodes and cells that all know; labels are 100 + index.
mesh::RawMesh spread(const std::vector<Eigen::Vector3d>& nodes, const std::vector<Cell>& cells) {
  mesh::RawMesh raw;
  raw.comm = PETSC_COMM_WORLD;
  raw.source = "test";
  raw.node_count = static_cast<PetscInt>(nodes.size());
  raw.cell_count = static_cast<PetscInt>(cells.size());
  const auto own = mesh::share_of(raw.node_count, testing::this_rank(), testing::ranks());
  const auto own_cells = mesh::share_of(raw.cell_count, testing::this_rank(), testing::ranks());
  raw.first_node = own.first;
  raw.first_cell = own_cells.first;
  raw.positions.assign(nodes.begin() + own.first, nodes.begin() + own.first + own.count);
  raw.cells.assign(cells.begin() + own_cells.first, cells.begin() + own_cells.first + own_cells.count);
  for (PetscInt i = 0; i < own.count; ++i) raw.node_labels.push_back(100 + own.first + i);
  for (PetscInt i = 0; i < own_cells.count; ++i) raw.cell_labels.push_back(100 + own_cells.first + i);
  return raw;
}

Cell triangle(PetscInt a, PetscInt b, PetscInt c) { return {CellKind::triangle, {a, b, c, -1}, 0}; }
Cell line(PetscInt a, PetscInt b) { return {CellKind::line, {a, b, -1, -1}, 0}; }

const std::vector<Eigen::Vector3d> corners{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0, 0}, {2, 0, 0}};

}  // namespace

TEST_CASE("a good mesh has no faults and no notices") {
  for (const bool triangles : {false, true}) {
    const auto path = testing::written("grid.msh", testing::gmsh_grid(6, 5, triangles));
    const auto found = mesh::inspect(mesh::read_gmsh(PETSC_COMM_WORLD, path).mesh);
    CHECK(found.faults.empty());
    CHECK(found.notices.empty());
    CHECK(found.component_count == 1);
  }
}

TEST_CASE("cells that are no cells are named") {
  const Cell folded{CellKind::quadrilateral, {0, 2, 1, 3}, 0};
  const auto found = mesh::inspect(
      spread(corners, {triangle(0, 1, 2), triangle(0, 1, 4), line(4, 5), line(3, 3), triangle(2, 0, 1), folded}));
  CHECK(found.faults == std::vector<std::string>{"test: element 101 has no area", "test: element 102 has no length",
                                                 "test: element 103 has the same node twice",
                                                 "test: element 104 has the nodes of element 100",
                                                 "test: element 105 has no area"});
  const std::vector<Eigen::Vector3d> dart{{0, 0, 0}, {1, 1, 0}, {0, 4, 0}, {-1, 1, 0}, {0, 1.5, 0}};
  const auto concave = mesh::inspect(spread(dart, {{CellKind::quadrilateral, {1, 2, 3, 4}, 0}, triangle(0, 1, 4)}));
  CHECK(concave.faults == std::vector<std::string>{"test: element 100 is folded: not convex"});
}

TEST_CASE("beams side by side are a fault, or a notice where they are meant") {
  const auto mesh =
      spread(corners, {line(0, 1), triangle(0, 1, 2), line(1, 0), line(1, 2), line(0, 1), triangle(2, 1, 0)});
  CHECK(mesh::inspect(mesh).faults.size() == 3);
  const auto found = mesh::inspect(mesh, {}, true);
  CHECK(found.faults == std::vector<std::string>{"test: element 105 has the nodes of element 101"});
  REQUIRE(!found.notices.empty());
  CHECK(found.notices[0] ==
        "test: 2 beams have the nodes of others, for example element 102 those of element 100: all of them count");
}

TEST_CASE("coordinates that are not finite are named") {
  auto nodes = corners;
  nodes[1][2] = std::nan("");
  const auto found = mesh::inspect(spread(nodes, {triangle(0, 1, 2), triangle(0, 2, 3)}));
  CHECK(found.faults == std::vector<std::string>{"test: node 101 has coordinates that are not finite"});
}

TEST_CASE("pieces are counted, and joined by connections") {
  const int n = 40;  // a chain that goes to and fro between the ranks, and a lone beam
  std::vector<Eigen::Vector3d> nodes;
  std::vector<Cell> cells;
  for (int i = 0; i < n + 2; ++i) nodes.emplace_back(i, 0, 0);
  for (int i = 0; i + 1 < n; ++i) cells.push_back(line(i * 7 % n, (i + 1) * 7 % n));  // 7 and 40 have no common factor
  cells.push_back(line(n, n + 1));
  const auto raw = spread(nodes, cells);
  const auto found = mesh::inspect(raw);
  CHECK(found.component_count == 2);
  REQUIRE(found.components.size() == 2);
  CHECK(found.components[0].nodes == n);
  CHECK(found.components[0].label == 100);
  CHECK(found.components[1].nodes == 2);
  CHECK(found.components[1].label == 140);
  REQUIRE(found.notices.size() == 1);
  CHECK(found.notices[0] == "test: the mesh is in 2 pieces: 40 nodes with node 100, 2 nodes with node 140");
  std::vector<std::array<PetscInt, 2>> link;
  if (testing::this_rank() == testing::ranks() - 1) link.push_back({3, n + 1});
  CHECK(mesh::inspect(raw, link).component_count == 1);
}

TEST_CASE("neighbours of opposite orientation are counted") {
  const auto found =
      mesh::inspect(spread({corners.begin(), corners.begin() + 4}, {triangle(0, 1, 2), triangle(0, 3, 2)}));
  CHECK(found.opposite_edges == 1);
  REQUIRE(found.notices.size() == 1);
  CHECK_THAT(found.notices[0], Contains("at 1 edges, for example element 100 and element 101"));
}
