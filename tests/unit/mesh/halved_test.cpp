#include "floe/generate/halved.h"

#include "generated.h"

using namespace floe;
using Eigen::Vector3d;
using mesh::CellKind;
using mesh::DependentNode;
using mesh::RawMesh;

namespace {

/// One or more elements between these points, on every rank.
RawMesh elements(CellKind kind, const std::vector<Vector3d>& positions,
                 const std::vector<std::vector<PetscInt>>& cells) {
  RawMesh raw;
  raw.comm = PETSC_COMM_SELF;
  raw.positions = positions, raw.parts = {"part"};
  for (std::size_t i = 0; i < positions.size(); ++i) raw.node_labels.push_back(10 * static_cast<long long>(i + 1));
  for (const auto& nodes : cells) {
    mesh::Cell cell{kind, mesh::no_nodes<PetscInt>(), 0};
    std::copy(nodes.begin(), nodes.end(), cell.nodes.begin());
    raw.cells.push_back(cell), raw.cell_labels.push_back(7 + static_cast<long long>(raw.cell_labels.size()));
  }
  raw.node_count = static_cast<PetscInt>(positions.size()), raw.cell_count = static_cast<PetscInt>(cells.size());
  return raw;
}

RawMesh halved(const RawMesh& raw, std::vector<DependentNode> links = {}) { return generate::halved(raw, links); }

using Points = std::set<std::array<long, 3>>;  // in 1e-9
std::array<long, 3> rounded(const Vector3d& x) {
  return {std::lround(1e9 * x[0]), std::lround(1e9 * x[1]), std::lround(1e9 * x[2])};
}

Points points(const RawMesh& raw, const std::vector<PetscInt>& nodes) {
  Points all;
  for (const PetscInt node : nodes) all.insert(rounded(raw.positions[node]));
  return all;
}

/// Elements by their corners' places, in any order.
std::set<Points> shapes(const RawMesh& raw) {
  std::set<Points> all;
  for (const mesh::Cell& cell : raw.cells)
    all.insert(points(raw, {cell.nodes.begin(), cell.nodes.begin() + mesh::corner_count(cell.kind)}));
  return all;
}

Vector3d middle_of(const RawMesh& raw, PetscInt a, PetscInt b) { return (raw.positions[a] + raw.positions[b]) / 2; }

}  // namespace

TEST_CASE("a plate of quadrilaterals that is halved is the plate of twice as many, with its places") {
  for (const PetscInt n : {1, 2, 3}) {
    const generate::Plate coarse{{1, 2, 3}, {4, 0, 0}, {1, 2, 0.5}, n, 2, generate::ShellCells::quadrilaterals};
    generate::Plate fine = coarse;
    fine.na *= 2, fine.nb *= 2;
    const RawMesh expected = generate::plate(PETSC_COMM_SELF, fine),
                  found = halved(generate::plate(PETSC_COMM_SELF, coarse));
    REQUIRE(found.node_count == expected.node_count);
    CHECK(found.cell_count == expected.cell_count);
    CHECK(shapes(found) == shapes(expected));
    CHECK(testing::topology_of(testing::whole(found)).euler == 1);  // and no edge is run along twice in one direction
    REQUIRE(found.places.size() >= 8);                              // of an even number of elements the centre, too
    for (std::size_t p = 0; p < found.places.size(); ++p) {
      INFO(found.places[p]);
      const auto same = std::find(expected.places.begin(), expected.places.end(), found.places[p]);
      REQUIRE(same != expected.places.end());
      CHECK(points(found, found.place_nodes[p]) ==
            points(expected, expected.place_nodes[same - expected.places.begin()]));
    }
    std::set<long long> labels(found.node_labels.begin(), found.node_labels.end());
    CHECK(static_cast<PetscInt>(labels.size()) == found.node_count);
  }
}

TEST_CASE("a plate of triangles that is halved keeps its area, its orientation and its boundary") {
  for (const auto diagonals : {generate::Diagonals::alternating, generate::Diagonals::crossed}) {
    generate::Plate plate{{0, 0, 0}, {3, 0, 0}, {1, 2, 0}, 3, 2, generate::ShellCells::triangles, diagonals};
    RawMesh raw = generate::plate(PETSC_COMM_SELF, plate);
    std::vector<PetscInt> rim;  // a place of the whole boundary: corners' chords are not part of it
    for (const char* side : {"left", "right", "bottom", "top"}) {
      const auto at = std::find(raw.places.begin(), raw.places.end(), side) - raw.places.begin();
      rim.insert(rim.end(), raw.place_nodes[at].begin(), raw.place_nodes[at].end());
    }
    std::sort(rim.begin(), rim.end());
    rim.erase(std::unique(rim.begin(), rim.end()), rim.end());
    raw.places.push_back("rim"), raw.place_nodes.push_back(rim);
    std::vector<PetscInt> all(raw.node_count);
    for (PetscInt i = 0; i < raw.node_count; ++i) all[i] = i;
    raw.places.push_back("all"), raw.place_nodes.push_back(all);
    const RawMesh fine = halved(raw);
    CHECK(fine.cell_count == 4 * raw.cell_count);
    const auto topology = testing::topology_of(testing::whole(fine));
    CHECK(topology.euler == 1);
    CHECK(topology.boundary_edges == 4 * (plate.na + plate.nb));
    CHECK(testing::measure(fine, 0) == Approx(testing::measure(raw, 0)).epsilon(1e-13));
    const auto size = [&](const char* name) {
      return fine.place_nodes[std::find(fine.places.begin(), fine.places.end(), name) - fine.places.begin()].size();
    };
    CHECK(size("left") == 2 * 2 + 1);
    CHECK(size("rim") == 4 * 5);
    CHECK(static_cast<PetscInt>(size("all")) == fine.node_count);
  }
}

// A crease within a mesh, at which no element is all in the place.
TEST_CASE("a line within a mesh keeps the nodes on it when the mesh is halved") {
  generate::Plate plate{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, 4, 4, generate::ShellCells::triangles};
  RawMesh raw = generate::plate(PETSC_COMM_SELF, plate);
  raw.places.push_back("crease"), raw.place_nodes.emplace_back();
  for (PetscInt i = 0; i < raw.node_count; ++i)
    if (raw.positions[i][0] == 2) raw.place_nodes.back().push_back(i);
  const RawMesh fine = halved(raw);
  CHECK(fine.place_nodes.back().size() == 9);
  for (const PetscInt node : fine.place_nodes.back()) CHECK(fine.positions[node][0] == 2);
}

// z = x^2 / 2 - x y + y^2 is a surface of second order in (x, y), and so is the element on a parallelogram.
TEST_CASE("elements of second order that are halved stay on their surface, with middles in the middle") {
  const auto on = [](double r, double s) {
    const double x = 2 * r + 0.3 * s, y = s;
    return Vector3d(x, y, x * x / 2 - x * y + y * y);
  };
  const std::vector<Vector3d> quadrilateral{on(-1, -1), on(1, -1), on(1, 1), on(-1, 1),
                                            on(0, -1),  on(1, 0),  on(0, 1), on(-1, 0)};
  const std::vector<Vector3d> triangles{on(-1, -1), on(1, -1), on(-1, 1), on(1, 1), on(0, -1),
                                        on(0, 0),   on(-1, 0), on(1, 0),  on(0, 1)};
  for (const RawMesh& raw : {elements(CellKind::quadrilateral8, quadrilateral, {{0, 1, 2, 3, 4, 5, 6, 7}}),
                             elements(CellKind::triangle6, triangles, {{0, 1, 2, 4, 5, 6}, {1, 3, 2, 7, 8, 5}})}) {
    const RawMesh fine = halved(raw), finest = halved(fine);
    CHECK(fine.cell_count == 4 * raw.cell_count);
    for (const RawMesh* one : {&fine, &finest}) {
      for (const Vector3d& x : one->positions)
        CHECK(x[2] == Approx(x[0] * x[0] / 2 - x[0] * x[1] + x[1] * x[1]).margin(1e-12));
      std::map<std::array<PetscInt, 2>, PetscInt> middles;
      for (const mesh::Cell& cell : one->cells) {
        const int n = mesh::corner_count(cell.kind);
        for (int i = 0; i < n; ++i) {
          const PetscInt a = cell.nodes[i], b = cell.nodes[(i + 1) % n], m = cell.nodes[n + i];
          const Vector3d off = one->positions[m] - middle_of(*one, a, b);
          CHECK(off.head<2>().norm() < 1e-12);
          const auto [at, fresh] = middles.emplace(std::array{std::min(a, b), std::max(a, b)}, m);
          CHECK(at->second == m);  // the same for both elements at an edge
        }
      }
    }
    CHECK(halved(fine).node_count == finest.node_count);
  }
  const RawMesh arc = halved(elements(CellKind::line3, {on(-1, 0), on(1, 0), on(0, 0)}, {{0, 1, 2}}));
  REQUIRE(arc.cell_count == 2);
  CHECK(arc.cells[0].nodes[1] == 2);
  CHECK((arc.positions[arc.cells[0].nodes[2]] - on(-0.5, 0)).norm() < 1e-14);
  CHECK((arc.positions[arc.cells[1].nodes[2]] - on(0.5, 0)).norm() < 1e-14);
}

TEST_CASE("masses, springs and undivided parts remain, and rigid regions receive the nodes between theirs") {
  RawMesh raw =
      elements(CellKind::line, {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {1.5, 1, 0}}, {{0, 1}, {1, 2}, {2, 3}});
  raw.parts = {"beam", "pinned", "mass"};
  raw.cells[2].part = 1;
  mesh::Cell mass{CellKind::point, mesh::no_nodes<PetscInt>(), 2},
      spring{CellKind::spring, mesh::no_nodes<PetscInt>(), 2};
  mass.nodes[0] = 4, spring.nodes[0] = 0, spring.nodes[1] = 4;
  raw.cells.push_back(mass), raw.cells.push_back(spring);
  raw.cell_labels = {1, 2, 3, 4, 5}, raw.cell_count = 5;
  std::vector<DependentNode> links{{1, 4}, {2, 4}};
  const RawMesh fine =
      generate::halved(raw, links, {generate::Halved::all, generate::Halved::none, generate::Halved::all});
  REQUIRE(fine.cell_count == 7);
  CHECK(fine.cell_labels == std::vector<long long>{1, 1, 2, 2, 3, 4, 5});
  CHECK(fine.cells[4].nodes == raw.cells[2].nodes);
  CHECK(fine.cells[5].nodes == mass.nodes);
  CHECK(fine.cells[6].nodes == spring.nodes);
  CHECK(fine.node_count == 7);
  REQUIRE(links.size() == 3);  // the node at x = 1.5
  CHECK(links[2].independent_node == 4);
  CHECK(fine.positions[links[2].node] == Vector3d(1.5, 0, 0));
}

TEST_CASE("shares of a mesh that is whole on every rank are those of the distributed mesh") {
  const generate::Plate plate{{0, 0, 0}, {3, 0, 0}, {1, 2, 0}, 3, 2};
  RawMesh whole = generate::plate(PETSC_COMM_SELF, plate);
  whole.comm = PETSC_COMM_WORLD;
  const RawMesh share = mesh::share_of_whole(whole), expected = generate::plate(PETSC_COMM_WORLD, plate);
  CHECK(share.first_node == expected.first_node);
  CHECK(share.first_cell == expected.first_cell);
  CHECK(testing::whole(share) == testing::whole(expected));
}
