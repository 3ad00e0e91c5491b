#include <cmath>

#include "floe/error.h"
#include "floe/output/reduced_file.h"
#include "read_back.h"
#include "reduced_file_sample.h"
#include "scratch.h"
#include "small_files.h"

using namespace floe;
using namespace floe::output;
using Catch::Matchers::Contains;

namespace {

constexpr int nodes = 12, dofs = 3;
using Kind = ReducedShapes::Kind;

double basis(int j, std::int64_t node, int dof) { return 100.0 * j + static_cast<double>(node) + 0.25 * dof; }

std::vector<ReducedShapes::Cell> all_cells() {
  std::vector<ReducedShapes::Cell> cells;
  for (std::int64_t i = 0; i < 8; ++i) cells.push_back({Kind::line, 0, {i + 1, i, -1, -1}});
  cells.push_back({Kind::triangle, 1, {9, 3, 10, -1}});
  cells.push_back({Kind::quadrilateral, 1, {9, 3, 10, 11}});
  cells.push_back({Kind::vertex, 2, {11, -1, -1, -1}});
  return cells;
}

/// Nodes and cells dealt to `ranks` as cards are, the last first; with four ranks, rank 1 gets none.
ReducedShapes dealt(MPI_Comm comm) {
  int rank = 0, size = 1;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &size);
  const auto mine = [&](std::int64_t i) { return (size == 4 && i % size == 1 ? 3 : i % size) == rank; };
  ReducedShapes shapes;
  for (std::int64_t i = nodes; i-- > 0;)
    if (mine(i)) {
      shapes.nodes.push_back(i);
      shapes.positions.emplace_back(0.1 * i, -1.0 * i, 0);
    }
  const auto cells = all_cells();
  for (std::size_t i = cells.size(); i-- > 0;)
    if (mine(static_cast<std::int64_t>(i))) shapes.cells.push_back(cells[i]);
  shapes.parts = {"spar", "skin", "lumps"};
  shapes.sets = {{"all", {}}, {"none", {}}, {"tip", {11}}};  // every rank names the tip
  for (std::int64_t i = 0; i < nodes; ++i)
    if (mine(i)) shapes.sets["all"].push_back(i);
  shapes.dofs_per_node = dofs;
  shapes.column = [numbers = shapes.nodes](int j, std::span<double> values) {
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = basis(j, numbers[i / dofs], i % dofs);
  };
  return shapes;
}

}  // namespace

TEST_CASE("shapes are written in original order, whoever holds them") {
  Scratch scratch;
  const ReducedShapes shapes = dealt(PETSC_COMM_WORLD);
  ReducedBodyFile file = sample_body(2, 4);
  write_reduced_body(PETSC_COMM_WORLD, scratch / "arm.h5", file, false, &shapes);
  file.has_shapes = true;
  check_same(read_reduced_body(PETSC_COMM_WORLD, scratch / "arm.h5"), file);
  const Hid plain = open_plain(scratch / "arm.h5");
  const auto positions = read_back(plain, "shapes/positions");
  CHECK(positions.shape == std::vector<hsize_t>{nodes, 3});
  for (int i = 0; i < nodes; ++i) CHECK((positions.data[3 * i] == 0.1 * i && positions.data[3 * i + 1] == -1.0 * i));
  const auto columns = read_back(plain, "shapes/basis");
  REQUIRE(columns.shape == std::vector<hsize_t>{4, nodes, dofs});
  bool right = true;
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < nodes * dofs; ++i)
      right = right && columns.data[j * nodes * dofs + i] == basis(j, i / dofs, i % dofs);
  CHECK(right);
  const auto cells = read_back(plain, "shapes/cells/nodes");
  REQUIRE(cells.shape == std::vector<hsize_t>{11, 4});
  CHECK(std::vector<double>(cells.data.begin(), cells.data.begin() + 8) ==
        std::vector<double>{1, 0, -1, -1, 2, 1, -1, -1});
  CHECK(read_back(plain, "shapes/cells/kind").data == std::vector<double>{3, 3, 3, 3, 3, 3, 3, 3, 5, 9, 1});
  CHECK(read_back(plain, "shapes/cells/part").data == std::vector<double>{0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 2});
  CHECK(read_back(plain, "shapes/sets/start").data == std::vector<double>{0, 12, 12, 13});
  CHECK(read_back(plain, "shapes/sets/nodes").data == std::vector<double>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 11});
  CHECK(read_text(plain, "shapes/sets/names", false).substr(0, 4) == std::string("all\0", 4));
}

TEST_CASE("the file with shapes does not depend on ranks") {
  Scratch scratch;
  const ReducedShapes shapes = dealt(PETSC_COMM_WORLD);
  write_reduced_body(PETSC_COMM_WORLD, scratch / "all.h5", sample_body(2, 4), false, &shapes);
  if (scratch.rank() != 0) return;
  const ReducedShapes alone = dealt(PETSC_COMM_SELF);
  write_reduced_body(PETSC_COMM_SELF, scratch / "one.h5", sample_body(2, 4), false, &alone);
  CHECK(text_of(scratch / "all.h5") == text_of(scratch / "one.h5"));
}

TEST_CASE("shapes of a rigid body are its mesh") {
  Scratch scratch;
  const ReducedShapes shapes = dealt(PETSC_COMM_WORLD);
  write_reduced_body(PETSC_COMM_WORLD, scratch / "arm.h5", sample_body(2, 0), false, &shapes);
  CHECK(read_back(open_plain(scratch / "arm.h5"), "shapes/basis").shape == std::vector<hsize_t>{0, nodes, dofs});
}

TEST_CASE("shapes that do not fit or find no room leave what was there") {
  Scratch scratch;
  const std::filesystem::path folder = scratch, path = folder / "arm.h5";
  write_reduced_body(PETSC_COMM_WORLD, path, sample_body(2, 1), false);
  const std::string before = text_of(path);
  const auto refused = [&](auto&& change, const std::string& why) {
    ReducedShapes shapes = dealt(PETSC_COMM_WORLD);
    change(shapes);
    try {
      write_reduced_body(PETSC_COMM_WORLD, path, sample_body(2, 4), true, &shapes);
      FAIL("written");
    } catch (const RunError& error) {
      CHECK_THAT(error.what(), Contains("cannot write " + path.string() + ":") && Contains(why));
    }
  };
  refused(
      [&](auto& s) {
        if (scratch.rank() == 0) s.nodes[0] = s.nodes[1];
      },
      "exactly one rank");
  refused(
      [&](auto& s) {
        if (scratch.rank() == 0) s.nodes[0] = nodes;
      },
      "without position");
  refused(
      [&](auto& s) {
        if (scratch.rank() == 0) s.cells.pop_back();
      },
      "10 elements, the body has 11");
  refused(
      [&](auto& s) {
        if (scratch.rank() == 0) s.cells[0].nodes[0] = 12;
      },
      "a node that the body does not have");
  refused(
      [&](auto& s) {
        if (scratch.rank() == 0) s.cells[0].part = 3;
      },
      "part without name");
  refused([&](auto& s) { s.dofs_per_node = 6; }, "36 dofs are not 6");
  refused([&](auto& s) { s.column = [](int, std::span<double> v) { std::fill(v.begin(), v.end(), NAN); }; },
          "basis vector 0 is not finite");
  refused(
      [&](auto& s) {
        s.column = [](int j, auto) {
          if (j == 2) throw RunError("lost");
        };
      },
      "lost");
  ReducedShapes unknown = dealt(PETSC_COMM_WORLD);
  unknown.column = [](int, std::span<double>) { throw InputError("unknown"); };
  CHECK_THROWS_AS(write_reduced_body(PETSC_COMM_WORLD, path, sample_body(2, 4), true, &unknown), InputError);
  {
    SmallFiles full(65536);  // room for the small data
    refused([](auto&) {}, "File too large");
  }
  meet();
  CHECK(text_of(path) == before);
  CHECK(std::distance(std::filesystem::directory_iterator(folder), {}) == 1);
}

// The draft as a kill would leave it at the worst moment: all ranks have the last column, nothing is published.
TEST_CASE("a draft with shapes does not read as a reduced body") {
  Scratch scratch;
  ReducedShapes shapes = dealt(PETSC_COMM_WORLD);
  shapes.column = [&, fill = shapes.column](int j, std::span<double> values) {
    fill(j, values);
    CHECK_FALSE(std::filesystem::exists(scratch / "arm.h5"));
    if (j == 3 && scratch.rank() == 0) std::filesystem::copy_file(scratch / ".arm.h5.partial", scratch / "killed.h5");
  };
  write_reduced_body(PETSC_COMM_WORLD, scratch / "arm.h5", sample_body(2, 4), false, &shapes);
  CHECK_THROWS_AS(read_reduced_body(PETSC_COMM_WORLD, scratch / "killed.h5"), InputError);
  CHECK_NOTHROW(read_reduced_body(PETSC_COMM_WORLD, scratch / "arm.h5"));
}
