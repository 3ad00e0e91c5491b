#include "floe/output/shape_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "dataset.h"
#include "floe/output/folder.h"
#include "floe/petsc/error.h"
#include "ordered_rows.h"
#include "reduced_file_hdf5.h"
#include "replaceable.h"
#include "reserve.h"
#include "shape_file_xdmf.h"
#include "writing.h"

namespace floe::output {
namespace fs = std::filesystem;
namespace {

int rank_of(MPI_Comm comm) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  return rank;
}

constexpr const char* shapes_format = "floe shapes";

void check_free(const fs::path& path, bool overwrite, bool ours) {
  const auto refuse = [&](const std::string& why) {
    throw InputError(fmt::format("shapes '{}': {}", path.string(), why));
  };
  std::error_code ignored;
  const auto status = fs::status(path, ignored);
  if (fs::exists(status) && !fs::is_regular_file(status)) refuse("exists and is not a file");
  if (fs::exists(status) && !ours) refuse("exists and holds no shapes of floe's; name another");
  if (fs::exists(status) && !overwrite) refuse("exists; name another, or replace it with --force");
  try {
    write_file_atomically(draft_of(path), "");
  } catch (const RunError& fault) {
    refuse(with_name(fault.what(), path));
  }
  fs::remove(draft_of(path), ignored);
}

/// XDMF's numbers of kinds; points and lines say how many nodes they have.
Integers mixed(const Integers& cells) {
  using Kind = ReducedShapes::Kind;
  Integers all;
  for (auto cell = cells.begin(); cell != cells.end(); cell += cell_width) {
    const Kind kind = static_cast<Kind>(cell[cell_width - 1]);
    const int count = corners(kind);
    all.push_back(count == 1 ? 1 : count == 2 ? 2 : count == 3 ? 4 : 5);
    if (count <= 2) all.push_back(count);
    all.insert(all.end(), cell, cell + count);
  }
  return all;
}

void write_fields(MPI_Comm comm, hid_t file, const ShapeGrid& grid, const NodeRows& rows) {
  constexpr int width = 6;
  std::vector<double> mine(width * grid.shapes.nodes.size());
  for (std::size_t f = 0; f < grid.fields.size(); ++f) {
    petsc::agree(comm, [&] {
      grid.shapes.column(static_cast<int>(f), mine);
      need(std::all_of(mine.begin(), mine.end(), [](double x) { return std::isfinite(x); }),
           grid.fields[f] + " is not finite");
    });
    const std::vector<double> share = rows.in_order(mine, width);
    std::vector<double> halves[2];
    for (std::size_t i = 0; i < share.size(); ++i) halves[i % width / 3].push_back(share[i]);
    for (int half = 0; half < 2; ++half)
      write_shared(comm, file, field_dataset(grid, f, half == 1), {hsize_t(grid.nodes), 3}, rows.first(), halves[half],
                   {"", grid.fields[f]});
  }
}

/// @return  how many numbers the topology has
std::int64_t write_grid(MPI_Comm comm, hid_t file, const ShapeGrid& grid) {
  const Shares shares(comm, grid.nodes);
  const NodeRows rows(comm, shares, grid.shapes.nodes);
  const Integers cells = cells_in_order(comm, shares, grid.shapes.cells);
  petsc::agree(comm, [&] { need(grid.shapes.dofs_per_node == 6, "need six dofs at a node"); });
  std::vector<double> positions;
  for (const auto& x : grid.shapes.positions) positions.insert(positions.end(), {x[0], x[1], x[2]});
  write_shared(comm, file, grid.name + "/positions", {hsize_t(grid.nodes), 3}, rows.first(),
               rows.in_order(positions, 3), {"m", "in the axes of the mesh"});
  write_shared(comm, file, grid.name + "/part", {hsize_t(grid.cells)}, sum_before(comm, std::ssize(cells) / cell_width),
               columns_of(cells, 4, 1), {"", fmt::format("{}", fmt::join(grid.shapes.parts, ", "))});
  const Integers topology = mixed(cells);
  const std::int64_t size = sum(comm, std::ssize(topology));
  write_shared(comm, file, grid.name + "/cells", {hsize_t(size)}, sum_before(comm, std::ssize(topology)), topology,
               {"", "mixed topology of XDMF: kind, count of points and lines, nodes from 0"});
  write_fields(comm, file, grid, rows);
  return size;
}

std::uint64_t bytes_of(const ShapeGrid& grid) {
  const std::uint64_t description = 4096;  // of a dataset
  return 8 * (grid.nodes * (3 + 6 * grid.fields.size()) + 7 * grid.cells) + description * (3 + 2 * grid.fields.size());
}

}  // namespace

fs::path data_of(const fs::path& xdmf) { return fs::path(xdmf).replace_extension(".h5"); }

void check_shapes_path(MPI_Comm comm, const fs::path& xdmf, bool overwrite) {
  petsc::agree(comm, [&] {
    if (rank_of(comm) != 0) return;
    if (xdmf.extension() != ".xdmf" || xdmf.stem().empty())
      throw InputError(fmt::format("shapes '{}': expected a name that ends in .xdmf", xdmf.string()));
    const fs::path data = data_of(xdmf);
    check_free(xdmf, overwrite, is_own_xdmf(xdmf)), check_free(data, overwrite, is_of_format(data, shapes_format));
  });
}

void write_shapes(MPI_Comm comm, const fs::path& xdmf, const std::vector<ShapeGrid>& grids) {
  const fs::path data = data_of(xdmf), draft = draft_of(data);
  const bool first = rank_of(comm) == 0;
  const auto alone = [&](const fs::path& path, const auto& work) {
    petsc::agree(comm, [&] {
      if (first) writing(path, work);
    });
  };
  std::vector<std::int64_t> sizes;
  try {
    alone(data, [&] {
      open_file(draft, Open::create, MPI_COMM_NULL).close();
      std::uint64_t bytes = 0;
      for (const ShapeGrid& grid : grids) bytes += bytes_of(grid);
      reserve(draft, bytes);
    });
    writing(data, [&] {
      Hid file;
      petsc::agree(comm, [&] { file = open_file(draft, Open::change, comm); });
      petsc::agree(comm, [&] { write_attribute(file, "format", shapes_format); });
      for (const ShapeGrid& grid : grids) sizes.push_back(write_grid(comm, file, grid));
      petsc::agree(comm, [&] { file.close(); });
    });
    alone(xdmf, [&] { fs::remove(xdmf); });
    alone(data, [&] { publish_draft(draft, data); });
    alone(xdmf, [&] { write_file_atomically(xdmf, xdmf_text(grids, sizes, data.filename().string())); });
  } catch (const RunError& fault) {
    std::error_code ignored;
    if (first) fs::remove(draft, ignored);
    throw RunError(with_name(fault.what(), data));
  }
}

}  // namespace floe::output
