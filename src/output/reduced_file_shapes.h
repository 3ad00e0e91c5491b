#pragma once
#include <mpi.h>

#include <filesystem>

#include "floe/output/reduced_file.h"

namespace floe::output {

/// Adds group `shapes` to the draft of a file: positions (nodes x 3), basis (k x nodes x dofs_per_node), cells, parts
/// and sets, in original order; cells by their nodes.
///
/// @throws RunError  on every rank: no room, numbers that do not fit the body
/// Collective. The disk's room is taken before HDF5 begins to write.
void add_shapes(MPI_Comm comm, const std::filesystem::path& draft, const ReducedBodyFile& file,
                const ReducedShapes& shapes);

}  // namespace floe::output
