#pragma once
#include <functional>
#include <span>
#include <string>

#include "ordered_rows.h"

/// A mesh and the columns of a basis on its nodes, as reduced bodies and results hold them, in original order.
namespace floe::output {

/// GROUP/positions (nodes x 3). Collective.
void write_positions(MPI_Comm comm, hid_t file, const std::string& group, hsize_t nodes, const NodeRows& rows,
                     const ReducedShapes& shapes);

/// GROUP/nodes (cells x 4), GROUP/part, GROUP/kind.
/// @param cells  of cells_in_order
/// Collective.
void write_cells(MPI_Comm comm, hid_t file, const std::string& group, hsize_t count, const Integers& cells);

/// An array, columns x nodes x shapes.dofs_per_node, one column in memory at a time.
/// @throws RunError  a number is not finite. Collective.
void write_columns(MPI_Comm comm, hid_t file, const std::string& name, hsize_t columns, hsize_t nodes,
                   const NodeRows& rows, const ReducedShapes& shapes, const Label& label);

}  // namespace floe::output
