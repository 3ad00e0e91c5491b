#pragma once
#include <optional>
#include <string>

#include "run.h"

namespace floe::app {

/// `floe run --restart`: takes up the run in a folder from its last checkpoint.
///
/// @param scene        where the run's scene is now; empty: where it was
/// @param formulation  that of the run, if given
/// @param plan         checkpoints; if it asks for none, as often as the run did
/// @throws InputError  no whole checkpoint, another scene, formulation, options or ranks. Collective.
void restart_one(const std::string& folder, const std::string& scene, const std::optional<std::string>& formulation,
                 const std::optional<double>& until, RunPlan plan, MPI_Comm comm);

}  // namespace floe::app
