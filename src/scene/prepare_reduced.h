#pragma once
#include "build_prepare.h"

namespace floe::scene {

/// A body from its file: no elements, but its frame where the scene puts it. Collective.
PreparedBody prepare_reduced(const Body& body, MPI_Comm comm);

/// Where a point of the floating frame lies in mesh axes; planar bodies leave the third coordinate at 0. [m]
Eigen::Vector3d in_mesh(const output::ReducedBodyFile& file, const Eigen::VectorXd& x);

/// The place of that name in the file.
/// @throws InputError  there is none, with the nearest; or coordinates, and a file without shapes
const output::ReducedPlace& named_place(const Body& body, const Place& place);

/// A place by its name, or a node of the file's shapes by its coordinates in mesh axes.
/// @throws InputError  as named_place; no node there. Collective.
PreparedPlace reduced_place(const Body& body, const Place& place, MPI_Comm comm);

/// A length of the body: the greatest distance of its places, at least twice its radius of gyration. [m]
double extent_of(const output::ReducedBodyFile& file);

}  // namespace floe::scene
