#pragma once
#include "floe/assembly/reduce_bodies.h"

namespace floe::assembly {

/// A plan, and what its bodies were reduced to; stays where it is, because its parts refer to one another.
struct Offline {
  Scene scene;  ///< bodies split into their frames
  Plan plan;
  std::vector<ReducedBody> reduced;

  /// Collective.
  Offline(Scene whole, MPI_Comm comm);
  Offline(const Offline&) = delete;
  Offline& operator=(const Offline&) = delete;
};

/// BodyReport::structure of a model of these bodies.
void give_structures(const std::shared_ptr<const Offline>& offline, Model& model);

/// Adds to the model's warnings those that depend on the scene, not on the basis: places beside nodes, axes of parts,
/// smoothed drives, and a start that stretches a body, which is also put into `stretched_start`. Collective.
void warn_of_scene(const Plan& plan, Model& model);

}  // namespace floe::assembly
