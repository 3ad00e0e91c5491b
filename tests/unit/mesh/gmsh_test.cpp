#include "floe/mesh/gmsh.h"

#include "gmsh_text.h"
#include "mesh_files.h"

using namespace floe;
using Catch::Matchers::Contains;
using testing::gmsh_grid;
using testing::GmshFormat;
using testing::written;

namespace {

const std::string folder = "tests/unit/mesh/files/";  // made by Gmsh 4.8 from plate.geo; binary 4.0, which it does not
                                                      // write, from the text of 4.0

const auto all_formats = {"plate_msh41.msh",        "plate_msh41_binary.msh", "plate_msh40.msh",
                          "plate_msh40_binary.msh", "plate_msh22.msh",        "plate_msh22_binary.msh"};

mesh::GmshFile read(const std::string& path, const std::vector<std::string>& parts = {}) {
  return mesh::read_gmsh(PETSC_COMM_WORLD, path, parts);
}

}  // namespace

TEST_CASE("files that Gmsh wrote, as text and binary, give the same mesh") {
  for (const std::string name : all_formats) {
    INFO(name);
    const auto file = read(folder + name);
    const auto& raw = file.mesh;
    CHECK(raw.parts == std::vector<std::string>{"skin"});
    CHECK(testing::measure(raw, 0) == Approx(2.0));  // the rectangle 2 x 1
    CHECK(testing::labels_at(raw, "corner") == std::vector<long long>{1});
    CHECK(testing::labels_at(raw, "root") == std::vector<long long>{1, 4, 13});  // x = 0
    CHECK(raw.places == std::vector<std::string>{"corner", "root", "stiffener", "skin"});
    REQUIRE(file.notices.size() == 1);
    CHECK_THAT(file.notices[0], Contains("nodes that no element uses are ignored"));  // of the free end of "stiffener"
  }
}

TEST_CASE("formats 2.0 and 2.1 are read as 2.2; names of groups need their dimension") {
  std::ifstream file(folder + "plate_msh22.msh");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const auto other = [&](const std::string& from, const std::string& to) {
    std::string changed = text;
    REQUIRE(changed.find(from) != std::string::npos);
    changed.replace(changed.find(from), from.size(), to);
    return written("other.msh", changed);
  };
  for (const char* version : {"2 0 8", "2.0 0 8", "2.1 0 8"}) {
    const auto raw = read(other("2.2 0 8", version)).mesh;
    CHECK(raw.parts == std::vector<std::string>{"skin"});
    CHECK(testing::measure(raw, 0) == Approx(2.0));
    CHECK(testing::labels_at(raw, "root") == std::vector<long long>{1, 4, 13});
  }
  const std::string bare = other("2 8 \"skin\"", "8 \"skin\"");
  CHECK_THAT(testing::fault_of([&] { read(bare); }), Contains("other.msh:9: a physical group has dimension 0 to 3"));
}

TEST_CASE("wanted parts are taken in the order that they are named in, curves as lines") {
  for (const std::string name : all_formats) {
    const auto file = read(folder + name, {"stiffener", "skin"});
    CHECK(file.mesh.parts == std::vector<std::string>{"stiffener", "skin"});
    CHECK(testing::measure(file.mesh, 0) == Approx(1 + std::sqrt(5.0)));
    CHECK(testing::measure(file.mesh, 1) == Approx(2.0));
    CHECK(file.notices.empty());
    CHECK(file.mesh.node_count == 22);
  }
}

TEST_CASE("every format holds the same grid") {
  for (const auto& format : {GmshFormat{}, GmshFormat{true, false, 8}, GmshFormat{true, true, 8},
                             GmshFormat{true, false, 4}, GmshFormat{true, true, 4}}) {
    for (const long long step : {1LL, 1000003LL % (format.width == 4 ? 1000LL : 2000000LL)}) {
      INFO("binary " << format.binary << ", swapped " << format.swapped << ", width " << format.width << ", step "
                     << step);
      const auto file = read(written("grid.msh", gmsh_grid(5, 3, false, step, format)));
      const auto& raw = file.mesh;
      CHECK(raw.node_count == 24);
      CHECK(raw.cell_count == 15);
      CHECK(testing::measure(raw, 0) == Approx(15.0));
      CHECK(testing::labels_at(raw, "left") == std::vector<long long>{step, 7 * step, 13 * step, 19 * step});
      const auto cells = testing::of_all_ranks(raw.cells);
      REQUIRE(cells.size() == 15);
      CHECK(cells[6].nodes ==
            std::array<PetscInt, mesh::most_nodes>{7, 8, 14, 13, -1, -1, -1, -1});  // second row, second square
      CHECK(testing::of_all_ranks(raw.cell_labels)[6] == 10);                       // after three lines
      CHECK(raw.positions.size() ==
            static_cast<std::size_t>(mesh::share_of(24, testing::this_rank(), testing::ranks()).count));
    }
  }
}

TEST_CASE("line ends of Windows are accepted") {
  std::string text = gmsh_grid(2, 2, true);
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2) text.insert(at, "\r");
  CHECK(read(written("windows.msh", text)).mesh.cell_count == 8);
}

namespace {

/// Ten nodes and an element of some of them.
std::string one_element(int type, const std::vector<int>& nodes) {
  std::string text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n10\n";
  for (int i = 1; i <= 10; ++i)
    text += std::to_string(i) + " " + std::to_string(i) + " " + std::to_string(i * i) + " 0\n";
  text += "$EndNodes\n$Elements\n1\n1 " + std::to_string(type) + " 2 0 1";
  for (const int node : nodes) text += " " + std::to_string(node);
  return text + "\n$EndElements\n";
}

}  // namespace

TEST_CASE("without physical groups all elements of the highest dimension are one part") {
  std::string text = gmsh_grid(2, 2, true);
  text.erase(text.find("$PhysicalNames"), text.find("$Nodes") - text.find("$PhysicalNames"));
  const auto raw = read(written("bare.msh", text)).mesh;
  CHECK(raw.parts == std::vector<std::string>{"mesh"});
  CHECK(testing::measure(raw, 0) == Approx(4.0));
}

TEST_CASE("elements of several physical groups belong to the part that is named, or to the first") {
  const std::string text =
      "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n2 1 \"skin\"\n2 5 \"patch\"\n$EndPhysicalNames\n"
      "$Entities\n0 0 2 0\n1 0 0 0 1 1 0 1 1 0\n2 1 0 0 2 1 0 2 1 5 0\n$EndEntities\n"
      "$Nodes\n1 6 1 6\n2 1 0 6\n1\n2\n3\n4\n5\n6\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n2 0 0\n2 1 0\n$EndNodes\n"
      "$Elements\n2 2 1 2\n2 1 3 1\n1 1 2 3 4\n2 2 3 1\n2 2 5 6 3\n$EndElements\n";
  const std::string path = written("overlap.msh", text);
  const auto first = mesh::read_gmsh(PETSC_COMM_WORLD, path);
  CHECK(first.mesh.parts == std::vector<std::string>{"skin"});
  CHECK(testing::measure(first.mesh, 0) == Approx(2));
  CHECK_THAT(first.notices.at(0), Contains("of group 'patch' 1 element belongs to part 'skin'"));
  const auto named = mesh::read_gmsh(PETSC_COMM_WORLD, path, {"patch"}, true);
  CHECK(named.mesh.parts == std::vector<std::string>{"patch", "skin"});
  CHECK(testing::measure(named.mesh, 0) == Approx(1));
  CHECK(testing::measure(named.mesh, 1) == Approx(1));
  CHECK_THAT(testing::fault_of([&] { read(path, {"skin", "patch"}); }), Contains("give one of them a section"));
}

TEST_CASE("parts that cannot be made are refused") {
  const auto path = folder + "plate_msh41.msh";
  CHECK_THAT(testing::fault_of([&] { read(path, {"skim"}); }), Contains("'skim'") && Contains("did you mean skin?"));
  CHECK_THAT(testing::fault_of([&] { read(path, {"corner"}); }), Contains("no physical group 'corner' with curves"));
  CHECK_THAT(testing::fault_of([&] { read(path, {"skin", "skin"}); }), Contains("two parts"));
  CHECK_THAT(testing::fault_of([&] {
               read(written("third.msh", one_element(21, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10})));
             }),
             Contains("'mesh'") && Contains("third-order triangle of 10 nodes"));
}

TEST_CASE("elements of second order are read; of nine nodes without the one in the middle") {
  const auto plate = read(folder + "plate_second_order.msh");
  CHECK(testing::measure(plate.mesh, 0) == Approx(2.0));
  for (const auto& cell : plate.mesh.cells) CHECK(cell.kind == mesh::CellKind::triangle6);
  const auto line = testing::of_all_ranks(read(written("line.msh", one_element(8, {1, 3, 2}))).mesh.cells);
  CHECK((line.at(0).kind == mesh::CellKind::line3 && line[0].nodes[1] == 2 && line[0].nodes[2] == 1));
  const auto eight = read(written("eight.msh", one_element(16, {1, 2, 3, 4, 5, 6, 7, 8})));
  CHECK(eight.notices.size() == 1);  // nodes without elements
  const auto nine = read(written("nine.msh", one_element(10, {1, 2, 3, 4, 5, 6, 7, 8, 9})));
  CHECK_THAT(nine.notices.at(0), Contains("1 quadrilaterals of 9 nodes are read as those of 8"));
  CHECK(nine.mesh.node_count == 8);
  const auto cells = testing::of_all_ranks(nine.mesh.cells);
  CHECK((cells.at(0).kind == mesh::CellKind::quadrilateral8 && cells[0].nodes[7] == 7));
}
