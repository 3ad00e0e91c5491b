#pragma once
#include "floe/assembly/model.h"
#include "floe/output/result_file.h"

namespace floe::app {

/// Where the bodies of a motion are found in result.h5, so that every node's place follows from the file alone:
///
///   x = R + A (X + u),  u = sum_j basis_j eta_j (reduced), or the node's dofs in motion/U (full order)
///
/// bodies/NAME: frame_at_start, columns_of_motion, shapes (mesh and basis; of a body from a file a link to it), and of
/// full order nodes_of_motion. Collective.
void write_bodies(output::ResultFile& file, const assembly::Model& model);

}  // namespace floe::app
