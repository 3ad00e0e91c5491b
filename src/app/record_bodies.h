#pragma once
#include "floe/assembly/model.h"
#include "floe/assess/estimate.h"
#include "floe/output/result_file.h"

namespace floe::app {

/// Where the bodies of a motion are found in result.h5, so that every node's place follows from the file alone:
///
///   x = R + A (X + u),  u = sum_j basis_j eta_j (reduced), or the node's dofs in motion/U (full order);
///   corotational: the node's dofs in world axes, in the plane displacement and angle, in space place and rotation
///   vector
///
/// bodies/NAME: frame_at_start, columns_of_motion, shapes (mesh and basis; of a body from a file a link to it), and of
/// full order nodes_of_motion. Collective.
void write_bodies(output::ResultFile& file, const assembly::Model& model);

/// What the error estimate found that the motion lacks, for what is recovered from it (floe stress): bodies/NAME:
/// estimate_basis, estimate_columns; estimate/deviation, of the coordinates on [basis estimate_basis]. Collective.
void write_deviation(output::ResultFile& file, const assembly::Model& model, const assess::Estimate& estimate);

/// U as files have it: of corotational nodes in space the rotation vector of the whole turn of the node's frame from
/// the undeformed body, world axes, where U has the rotation within a step (dynamics::Attitude). Null: U itself.
/// Collective.
petsc::VecHandle shown_state(const assembly::Model& model, Vec U);

}  // namespace floe::app
