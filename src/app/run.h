#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "checkpoint.h"
#include "floe/assess/validity.h"
#include "floe/output/folder.h"
#include "floe/solve/simulation.h"

namespace floe::app {

/// The probes over time, for comparisons.
struct Series {
  std::vector<double> t;
  std::vector<std::vector<double>> values;  ///< of each instant
  std::vector<assembly::ProbeColumn> columns;
  std::vector<dynamics::Energy> energy;  ///< of each instant
};

/// What a run gives back.
struct RunResult {
  Series series;
  nlohmann::ordered_json summary;
  std::string label;  ///< `12 VMs + 5 MDs`
  PetscInt coordinates = 0;
  double offline_seconds = 0, motion_seconds = 0;
  double motion_processor = 0;  ///< processor time of the motion on this rank [s]
  PetscInt steps = 0;
  double end = 0;  ///< reached [s]
  std::vector<std::string> warnings;
  assess::Estimate estimate;
  bool impulsive = false;  ///< assess::KeptMotion::impulsive: the estimate, if it is not one by full order, is too low
  std::vector<assess::OutOfRange> out_of_range;  ///< their texts are among the warnings
  std::vector<solve::State> states;              ///< some, along the motion, if they were to be kept
};

/// What keeps a run from being lost, and where it begins and ends.
struct RunPlan {
  CheckpointEvery checkpoints;
  std::optional<output::Checkpoint> from = {};   ///< of the run in the folder, which is taken up again
  std::optional<double> until = {};              ///< [s]; else the scene's motion.end
  bool quiet = false;                            ///< shows no progress
  bool estimate = false;                         ///< of the error, of reduced formulations (assess::estimate_error)
  bool budget = true;                            ///< with the estimate: all parts of the error (error_budget.h)
  std::optional<double> required = {};           ///< total error that the model was selected for
  std::vector<std::string> made_rigid = {};      ///< bodies that the selection made rigid
  std::string no_model = {};                     ///< why the error of the model is not to be estimated
  std::optional<double> estimate_seconds = {};   ///< that it may take; else a tenth of all the rest
  bool check_range = true;                       ///< assess::out_of_range
  bool measured = false;                         ///< against full order: warns only of what full order errs in, too
  nlohmann::ordered_json choice = {};            ///< how the model was chosen, for the summary
  bool keep_states = false;                      ///< RunResult::states
  bool energies = true;                          ///< of each stored instant (Series::energy); else zeros
  double newton_tolerance = 0;                   ///< solve::Integration::newton_tolerance
  bool balance = true;                           ///< violation of constraints, growth of energy without work
  std::optional<double> offline_processor = {};  ///< processor time of building the model [s]; else as it took
};

/// Builds, moves and writes one scene in one formulation.
/// @param folder  none: nothing is written, and no checkpoints
/// @throws InputError, RunError. What was reached before a failure is written. Collective.
RunResult run(const scene::Scene& scene, scene::Formulation formulation, MPI_Comm comm,
              const std::optional<output::ResultFolder>& folder, const RunPlan& plan = {});

/// The second half of run(): moves a model of the scene, which lives on `comm` or, reduced, on every rank of it alike.
RunResult move(const scene::Scene& scene, assembly::Model& model, double offline_seconds, MPI_Comm comm,
               const std::optional<output::ResultFolder>& folder, const RunPlan& plan = {});

/// What a body was reduced to, as `12 VMs + 5 MDs + 2 AMs`.
std::string label_of(const assembly::Model& model);

}  // namespace floe::app
