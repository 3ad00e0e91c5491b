#pragma once
#include <mpi.h>

#include <filesystem>
#include <string>
#include <vector>

#include "floe/output/reduced_file.h"

namespace floe::output {

/// A body's mesh with fields on its nodes, for pictures: this rank's share.
struct ShapeGrid {
  std::string name;
  std::int64_t nodes = 0, cells = 0;  ///< of all ranks
  std::vector<std::string> fields;    ///< `mode 1 (12.3 Hz)`; the same on every rank
  ReducedShapes shapes;  ///< six dofs a node: displacement and rotation vector; column(j) gives field j. `sets` are not
                         ///< written
};

/// The HDF5 file beside an XDMF file: modes.xdmf, modes.h5.
std::filesystem::path data_of(const std::filesystem::path& xdmf);

/// Refuses what write_shapes could not write, before the work is done.
///
/// @throws InputError  no name that ends in .xdmf; one of both files exists and not `overwrite`, or no file can be made
///                     there. Collective; rank 0 alone touches the file system.
void check_shapes_path(MPI_Comm comm, const std::filesystem::path& xdmf, bool overwrite);

/// Writes an XDMF file (small, by rank 0) over an HDF5 file (by all ranks together), for ParaView: one uniform grid a
/// body; of each field two vectors at the nodes, `NAME` and `NAME, rotation`; `part` of each element.
///
/// In HDF5: NAME/positions (n x 3), NAME/cells (XDMF's mixed topology: kind, count where the kind has none, nodes),
/// NAME/part, and NAME/field I/displacement and rotation (n x 3). Nodes and cells stand in original order: the files do
/// not depend on the number of ranks. Either is a draft until it is whole, and an older pair is taken away first, so
/// that no kill leaves half a file, or a description of another one's data.
/// @throws RunError  path and reason. Collective.
void write_shapes(MPI_Comm comm, const std::filesystem::path& xdmf, const std::vector<ShapeGrid>& grids);

}  // namespace floe::output
