#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "floe/dynamics/simulation.h"
#include "floe/output/folder.h"
#include "floe/scene/range.h"

namespace floe::app {

/// The probes over time, for comparisons.
struct Series {
  std::vector<double> t;
  std::vector<std::vector<double>> values;  ///< of each instant
  std::vector<scene::ProbeColumn> columns;
  std::vector<dynamics::Energy> energy;  ///< of each instant
};

/// What a run gives back.
struct RunResult {
  Series series;
  nlohmann::ordered_json summary;
  std::string label;  ///< `12 VMs + 5 MDs`
  PetscInt coordinates = 0;
  double offline_seconds = 0, motion_seconds = 0;
  PetscInt steps = 0;
  double end = 0;  ///< reached [s]
  std::vector<std::string> warnings;
  scene::Estimate estimate;
  std::vector<scene::OutOfRange> out_of_range;  ///< their texts are among the warnings
};

/// Builds, moves and writes one scene in one formulation.
/// @param folder    none: nothing is written
/// @param estimate  of the error, of reduced formulations (scene::estimate_error); it takes about a tenth of the time
///                  of all the rest, or a quarter of a second
/// @throws InputError, RunError. What was reached before a failure is written. Collective.
RunResult run(const scene::Scene& scene, scene::Formulation formulation, MPI_Comm comm,
              const std::optional<output::ResultFolder>& folder, bool estimate = false);

/// What a body was reduced to, as `12 VMs + 5 MDs + 2 AMs`.
std::string label_of(const scene::Model& model);

}  // namespace floe::app
