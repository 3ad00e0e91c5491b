#pragma once
#include "floe/assembly/model.h"

namespace floe::assembly {

/// Bodies reduced once, for scenes of the same offline_inputs().
struct ReducedBodies;
/// Collective. @throws as build()
std::shared_ptr<const ReducedBodies> reduce_once(const Scene& scene, Formulation formulation, MPI_Comm comm);
/// The model of a scene on such bodies; the formulation is theirs. Its range can be checked; there is no estimate of
/// its error, because the factors of K are gone. Collective over the communicator that they were reduced on.
Model build_on(const ReducedBodies& bodies, const Scene& scene);

}  // namespace floe::assembly
