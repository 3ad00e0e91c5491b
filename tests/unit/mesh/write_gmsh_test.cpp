#include "floe/mesh/write_gmsh.h"

#include "floe/mesh/gmsh.h"
#include "generated.h"
#include "gmsh_text.h"

using namespace floe;
using Catch::Matchers::Contains;
using mesh::GmshEncoding;
using mesh::RawMesh;

namespace {

// As written() names it.
std::string path_of(const std::string& name) { return testing::written(name, ""); }

// With a place for each part, as read_gmsh has them.
testing::Whole with_parts_as_places(testing::Whole all) {
  for (const auto& cell : all.cells)
    for (int k = 0; k < mesh::node_count(static_cast<mesh::CellKind>(cell[0])); ++k)
      all.places[all.parts[cell[1]]].insert(cell[2 + k]);
  return all;
}

void check_round_trip(const RawMesh& raw) {
  const auto expected = with_parts_as_places(testing::whole(raw));
  for (const auto encoding : {GmshEncoding::ascii, GmshEncoding::binary}) {
    const auto path = path_of("written.msh");
    mesh::write_gmsh(path, raw, encoding);
    const auto read = mesh::read_gmsh(PETSC_COMM_WORLD, path, raw.parts);
    CHECK(read.notices.empty());
    const auto all = testing::whole(read.mesh);
    CHECK(all.positions == expected.positions);
    CHECK(all.cells == expected.cells);
    CHECK(all.labels == expected.labels);
    CHECK(all.parts == expected.parts);
    CHECK(all.places == expected.places);
  }
}

const generate::Plate skew{{0.1, 0.2, 1 / 3.}, {1e-7, 1 / 7., 0}, {0, 1e9, -1}, 7, 5};

}  // namespace

TEST_CASE("plates of triangles and quadrilaterals come back as they were written") {
  for (const auto cells : {generate::ShellCells::triangles, generate::ShellCells::quadrilaterals}) {
    generate::Plate plate = skew;
    plate.cells = cells;
    check_round_trip(generate::plate(PETSC_COMM_WORLD, plate));
  }
}

TEST_CASE("folded plates, lattices and beams on a shell come back as they were written") {
  const generate::Plate web{{0, 0, 0}, {4, 0, 0}, {0, 0, 1}, 6, 2}, flange{{0, 0, 1}, {4, 0, 0}, {0, 1, 0}, 6, 3};
  check_round_trip(generate::folded_plates(PETSC_COMM_WORLD, {{"web", web}, {"top flange", flange}}));
  check_round_trip(generate::lattice(PETSC_COMM_WORLD, {2, 3, 2, {1, 1, 1}, generate::LatticeDiagonals::all}));
  const auto lines =
      generate::polyline(PETSC_COMM_WORLD, {{{0, 0, 0}, {4, 0, 0}, {4, -1, 0}}, {}, {6, 2}, {"keel", "arm"}});
  check_round_trip(generate::merged(generate::plate(PETSC_COMM_WORLD, web), lines, {{"bottom", "keel"}}, 1e-6));
}

TEST_CASE("a part of triangles and quadrilaterals, and a mesh smaller than the ranks, come back") {
  generate::MappedGrid cone{6, 3, [](double u, double v) {
                              const double angle = 6.283185307179586 * u;
                              return Eigen::Vector3d(v * std::cos(angle), v * std::sin(angle), v);
                            }};
  cone.closed_u = cone.pole_bottom = true;
  cone.cells = generate::ShellCells::quadrilaterals;
  check_round_trip(generate::shell_of(PETSC_COMM_WORLD, cone));
  check_round_trip(generate::polyline(PETSC_COMM_WORLD, {{{0, 0, 0}, {1, 0, 0}}, {}, {1}, {}}));
}

TEST_CASE("what was read with labels of its own is written with them") {
  const auto path = testing::written("source.msh", testing::gmsh_grid(5, 4, true, 10));
  check_round_trip(mesh::read_gmsh(PETSC_COMM_WORLD, path, {"grid"}).mesh);
}

TEST_CASE("the file does not depend on the number of ranks") {
  const auto bytes = [](const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  const auto alone = path_of("alone" + std::to_string(testing::this_rank()) + ".msh"), together = path_of("all.msh");
  for (const auto encoding : {GmshEncoding::ascii, GmshEncoding::binary}) {
    mesh::write_gmsh(alone, generate::plate(PETSC_COMM_SELF, skew), encoding);
    mesh::write_gmsh(together, generate::plate(PETSC_COMM_WORLD, skew), encoding);
    CHECK(bytes(alone) == bytes(together));
    CHECK(bytes(alone).size() > 1000);
    // nor where the least labels are on the last rank
    const auto descending = [](RawMesh raw) {
      for (auto* labels : {&raw.node_labels, &raw.cell_labels})
        for (long long& label : *labels) label = 1000 - label;
      return raw;
    };
    mesh::write_gmsh(alone, descending(generate::plate(PETSC_COMM_SELF, skew)), encoding);
    mesh::write_gmsh(together, descending(generate::plate(PETSC_COMM_WORLD, skew)), encoding);
    CHECK(bytes(alone) == bytes(together));
  }
}

TEST_CASE("what cannot be written is refused on every rank") {
  const auto fault = [](const RawMesh& raw) {
    return testing::fault_of([&] { mesh::write_gmsh(path_of("bad.msh"), raw); });
  };
  auto named = generate::plate(PETSC_COMM_WORLD, skew);
  named.places[0] = "the \"left\"";
  CHECK_THAT(fault(named), Contains("cannot be that of a physical group"));
  auto mixed =
      generate::merged(generate::plate(PETSC_COMM_WORLD, skew),
                       generate::polyline(PETSC_COMM_WORLD, {{{5, 5, 5}, {6, 5, 5}}, {}, {2}, {"plate"}}), {}, 1e-6);
  CHECK_THAT(fault(mixed), Contains("part 'plate' has elements of several dimensions"));
  CHECK_THROWS_AS(mesh::write_gmsh("/no/such/folder/a.msh", generate::plate(PETSC_COMM_WORLD, skew)), RunError);
}
