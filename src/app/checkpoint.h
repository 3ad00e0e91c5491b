#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "floe/assembly/model.h"
#include "floe/output/checkpoint_file.h"
#include "floe/solve/motion_state.h"

namespace floe::app {

/// How often checkpoints are written; neither: never.
struct CheckpointEvery {
  PetscInt steps = 0;
  double seconds = 0;  ///< of wall time
  bool any() const { return steps > 0 || seconds > 0; }
};
/// `1000`: steps; `60s`: seconds. @throws InputError
CheckpointEvery checkpoint_every(const std::string& word);

/// What a run must have in common with the one that it takes up: scene, the files that it names, formulation, options
/// of solvers, ranks. Files are compared by their contents (FNV-1a). Collective.
nlohmann::ordered_json identity_of(const scene::Scene& scene, scene::Formulation formulation, MPI_Comm comm);
/// @throws InputError  what differs, a line each
void check_identity(const nlohmann::ordered_json& of_checkpoint, const nlohmann::ordered_json& now,
                    const std::string& folder);

/// A state of the motion among the numbers of a checkpoint.
void put_state(const solve::MotionState& state, output::Checkpoint& checkpoint);
solve::MotionState state_of(const output::Checkpoint& checkpoint);

}  // namespace floe::app
