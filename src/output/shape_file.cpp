#include "floe/output/shape_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "floe/petsc/error.h"
#include "shape_file_xdmf.h"
#include "xdmf.h"

namespace floe::output {
namespace fs = std::filesystem;
namespace {

XdmfPair pair_of(const fs::path& xdmf) { return {xdmf, "shapes", "floe shapes"}; }

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
  const Integers topology = mixed_topology(cells);
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

fs::path data_of(const fs::path& xdmf) { return pair_of(xdmf).data(); }

void check_shapes_path(MPI_Comm comm, const fs::path& xdmf, bool overwrite) {
  check_pair(comm, pair_of(xdmf), overwrite);
}

void write_shapes(MPI_Comm comm, const fs::path& xdmf, const std::vector<ShapeGrid>& grids) {
  std::uint64_t bytes = 0;
  for (const ShapeGrid& grid : grids) bytes += bytes_of(grid);
  std::vector<std::int64_t> sizes;
  write_pair(
      comm, pair_of(xdmf), bytes,
      [&](hid_t file) {
        for (const ShapeGrid& grid : grids) sizes.push_back(write_grid(comm, file, grid));
      },
      [&] { return xdmf_text(grids, sizes, data_of(xdmf).filename().string()); });
}

}  // namespace floe::output
