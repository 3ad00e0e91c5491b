#include "shape_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "floe/petsc/error.h"
#include "reduced_file_hdf5.h"

namespace floe::output {

void write_positions(MPI_Comm comm, hid_t file, const std::string& group, hsize_t nodes, const NodeRows& rows,
                     const ReducedShapes& shapes) {
  std::vector<double> positions;
  for (const auto& x : shapes.positions) positions.insert(positions.end(), {x[0], x[1], x[2]});
  write_shared(comm, file, group + "/positions", {nodes, 3}, rows.first(), rows.in_order(positions, 3),
               {"m", "in the axes of the floating frame"});
}

void write_cells(MPI_Comm comm, hid_t file, const std::string& group, hsize_t count, const Integers& cells) {
  const hsize_t first = sum_before(comm, std::ssize(cells) / cell_width);
  write_shared(comm, file, group + "/nodes", {count, 4}, first, columns_of(cells, 0, 4),
               {"", "original numbers, from 0; -1 where unused"});
  write_shared(comm, file, group + "/part", {count}, first, columns_of(cells, 4, 1), {"", "index of shapes/parts"});
  write_shared(comm, file, group + "/kind", {count}, first, columns_of(cells, 5, 1),
               {"", "VTK cell types: 1 vertex, 3 line, 5 triangle, 9 quadrilateral"});
}

void write_columns(MPI_Comm comm, hid_t file, const std::string& name, hsize_t columns, hsize_t nodes,
                   const NodeRows& rows, const ReducedShapes& shapes, const Label& label) {
  const hsize_t width = shapes.dofs_per_node;
  Hid dataset;
  petsc::agree(comm, [&] { dataset = create_dataset<double>(file, name, {columns, nodes, width}, label); });
  std::vector<double> mine(shapes.nodes.size() * width);
  for (hsize_t j = 0; j < columns; ++j) {
    petsc::agree(comm, [&] { shapes.column(static_cast<int>(j), mine); });
    const auto share = rows.in_order(mine, static_cast<int>(width));
    petsc::agree(comm, [&] {
      need(std::all_of(share.begin(), share.end(), [](double x) { return std::isfinite(x); }),
           fmt::format("basis vector {} is not finite", j));
      write_rows<double>(dataset, {j, hsize_t(rows.first()), 0}, {1, share.size() / width, width}, share, true);
    });
  }
  petsc::agree(comm, [&] { dataset.close(); });
}

}  // namespace floe::output
