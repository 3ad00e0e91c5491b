#pragma once
#include "floe/plan/prepare.h"

namespace floe::plan {

/// A body from its file: no elements, but its frame where the scene puts it. Collective.
PlannedBody prepare_reduced(const Body& body, MPI_Comm comm);

/// The first place of the file at a point, so that one node has one number; else a number behind the places'.
PetscInt number_in_file(const output::ReducedBodyFile& file, const Eigen::VectorXd& x, PetscInt other = 0);

/// A place by its name, or a node of the file's shapes by its coordinates in mesh axes.
/// @throws InputError  as named_place; no node there. Collective.
Anchor reduced_place(const Body& body, const Place& place, MPI_Comm comm);

}  // namespace floe::plan
