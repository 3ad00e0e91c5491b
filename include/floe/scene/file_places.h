#pragma once
#include "floe/scene/scene.h"

namespace floe::scene {

/// Where a point of the floating frame lies in mesh axes; planar bodies leave the third coordinate at 0. [m]
Eigen::Vector3d in_mesh(const output::ReducedBodyFile& file, const Eigen::VectorXd& x);

/// The place of that name in the file.
/// @throws InputError  there is none, with the nearest; or coordinates, and a file without shapes
const output::ReducedPlace& named_place(const Body& body, const Place& place);

/// A length of the body: the maximum distance of its places, at least twice its radius of gyration. [m]
double extent_of(const output::ReducedBodyFile& file);

}  // namespace floe::scene
