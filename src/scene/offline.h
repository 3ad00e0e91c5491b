#pragma once
#include "build_reduce.h"

namespace floe::scene {

/// Prepared bodies, and what they were reduced to; stays where it is, because its parts refer to one another.
struct Offline {
  Scene scene;  ///< bodies split into their frames
  Prepared prepared;
  std::vector<ReducedBody> reduced;

  /// Collective.
  Offline(Scene whole, MPI_Comm comm) : scene(std::move(whole)), prepared(prepare(scene, comm)) {}
  Offline(const Offline&) = delete;
  Offline& operator=(const Offline&) = delete;
};

/// BodyReport::structure of a model of these bodies.
void give_structures(const std::shared_ptr<const Offline>& offline, Model& model);

}  // namespace floe::scene
