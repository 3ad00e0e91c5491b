#include "floe/output/shape_file.h"

#include <catch2/catch.hpp>

#include "floe/error.h"
#include "read_back.h"
#include "scratch.h"
#include "small_files.h"

using namespace floe;
using namespace floe::output;

namespace {

/// Five nodes dealt to the ranks in turn, a cell of each kind on the last; field j at node n is 100 j + 10 n + 0 ... 5.
ShapeGrid dealt() {
  using Kind = ReducedShapes::Kind;
  int rank = 0, size = 1;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  ShapeGrid grid{"b<1>", 5, 4, {"mode 1 (2 Hz)", "derivative 1,1"}, {}};
  ReducedShapes& shapes = grid.shapes;
  shapes.dofs_per_node = 6;
  shapes.parts = {"skin"};
  for (int n = 4; n >= 0; --n) {
    if (n % size != rank) continue;
    shapes.nodes.push_back(n);
    shapes.positions.emplace_back(n, 2 * n, 0.5);
  }
  if (rank == size - 1)
    shapes.cells = {{Kind::quadrilateral, 0, {3, 0, 1, 2}},
                    {Kind::triangle, 0, {1, 2, 4, -1}},
                    {Kind::line, 0, {0, 1, -1, -1}},
                    {Kind::vertex, 0, {4, -1, -1, -1}}};
  shapes.column = [nodes = shapes.nodes](int j, std::span<double> values) {
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] = 100.0 * j + 10.0 * static_cast<double>(nodes[i / 6]) + static_cast<double>(i % 6);
  };
  return grid;
}

}  // namespace

TEST_CASE("shapes stand in original order whatever ranks they were on") {
  const Scratch scratch;
  check_shapes_path(PETSC_COMM_WORLD, scratch / "m.xdmf", false);
  write_shapes(PETSC_COMM_WORLD, scratch / "m.xdmf", {dealt()});
  meet();
  const Hid file = open_plain((scratch / "m.h5").string());
  using Numbers = std::vector<double>;
  CHECK(read_back(file, "b<1>/cells").data == Numbers{2, 2, 0, 1, 4, 1, 2, 4, 5, 3, 0, 1, 2, 1, 1, 4});
  CHECK(read_back(file, "b<1>/positions").data == Numbers{0, 0, .5, 1, 2, .5, 2, 4, .5, 3, 6, .5, 4, 8, .5});
  CHECK(read_back(file, "b<1>/field_2/displacement").shape == std::vector<hsize_t>{5, 3});
  CHECK(read_back(file, "b<1>/field_1/displacement").data ==
        Numbers{0, 1, 2, 10, 11, 12, 20, 21, 22, 30, 31, 32, 40, 41, 42});
  CHECK(read_back(file, "b<1>/field_2/rotation").data ==
        Numbers{103, 104, 105, 113, 114, 115, 123, 124, 125, 133, 134, 135, 143, 144, 145});
  const std::string text = text_of(scratch / "m.xdmf");
  CHECK(text.find("<Attribute Name=\"derivative 1,1, rotation\" AttributeType=\"Vector\"") != std::string::npos);
  CHECK(text.find(">m.h5:/b&lt;1&gt;/field_1/displacement<") != std::string::npos);
  CHECK(text.find("Dimensions=\"16\"") != std::string::npos);
}

TEST_CASE("shapes replace nothing unasked, and a fault leaves what was there") {
  const Scratch scratch;
  const auto path = scratch / "m.xdmf";
  for (const char* name : {"m.h5", "", ".xdmf"})
    CHECK_THROWS_AS(check_shapes_path(PETSC_COMM_WORLD, scratch / name, true), InputError);
  CHECK_THROWS_WITH(check_shapes_path(PETSC_COMM_WORLD, scratch / "none" / "m.xdmf", true),
                    Catch::Contains("none/m.xdmf") && !Catch::Contains("partial"));
  if (scratch.rank() == 0)
    std::ofstream(scratch / "other.xdmf") << "<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\"/>\n";
  meet();
  CHECK_THROWS_WITH(check_shapes_path(PETSC_COMM_WORLD, scratch / "other.xdmf", true),
                    Catch::Contains("contains no shapes written by floe"));
  meet();
  if (scratch.rank() == 0) std::filesystem::remove(scratch / "other.xdmf");
  write_shapes(PETSC_COMM_WORLD, path, {dealt()});
  meet();
  CHECK_THROWS_WITH(check_shapes_path(PETSC_COMM_WORLD, path, false),
                    Catch::Contains("m.xdmf': exists; use another name"));
  CHECK_NOTHROW(check_shapes_path(PETSC_COMM_WORLD, path, true));
  const std::string xdmf = text_of(path), data = text_of(scratch / "m.h5");
  ShapeGrid bad = dealt();
  bad.shapes.column = [](int, std::span<double> values) { std::fill(values.begin(), values.end(), NAN); };
  CHECK_THROWS_WITH(write_shapes(PETSC_COMM_WORLD, path, {bad}), Catch::Contains("mode 1 (2 Hz) is not finite"));
  {
    const SmallFiles full(4096);
    CHECK_THROWS_AS(write_shapes(PETSC_COMM_WORLD, path, {dealt()}), RunError);
  }
  meet();
  CHECK(text_of(path) == xdmf);
  CHECK(text_of(scratch / "m.h5") == data);
  CHECK(std::distance(std::filesystem::directory_iterator(scratch), {}) == 2);
}
