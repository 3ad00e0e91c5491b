#pragma once
#include <string>
#include <utility>
#include <vector>

#include "floe/assess/candidate_basis.h"
#include "floe/output/table.h"
#include "run.h"

namespace floe::app {

/// One of the things that were chosen, and the measured reason.
struct Decision {
  std::string what, choice, reason;
};

/// The cheapest model found of a scene within an accuracy.
struct Chosen {
  std::unique_ptr<assess::CandidateBasis> candidates;  ///< of the model's basis; none: the scene's own
  assess::Selection selection;
  scene::Scene scene;  ///< with the step that was chosen
  assembly::Model model;
  bool total = false;                                          ///< chosen for the total error
  std::vector<std::pair<std::string, std::string>> unbounded;  ///< parts of the total that are not bounded, and why
  nlohmann::ordered_json before;  ///< total: the estimate of the scene's own model, as in a summary
  double asked = 0;
  double supported = 0;  ///< estimate of the reference's error, and how far the chosen model is from that
  double richest = 0;  ///< of which the reference's: of the richest model (estimate, step, mesh), or of formulation cfr
  bool within() const { return supported <= asked; }
  int trials = 0;       ///< motions, of reduced models
  double building = 0;  ///< processor time of the candidate basis [s]
  double seconds = 0;
  std::vector<Decision> decisions;
};

/// Chooses columns, elastic force and step of a scene's reduced model for an error of its probes (each as a vector,
/// root mean square over that of the probe, against the full order of the same mesh, exact in time).
///
/// The richest model of a candidate basis (assess::CandidateBasis) is moved; its error is estimated without full order
/// (assess::estimate_error), the responses that the estimate finds join it until it is small, and its step is halved
/// until that changes little. It then stands for the truth: cheaper models are moved, too, and measured against it.
/// Columns go in the order of their energy contribution, the least important first, by bisection; the step is doubled
/// for as long as it may be; what is left of the time budget goes to columns again, and to a linear elastic force.
///
/// @throws InputError  no probes; nothing to support a choice (no estimate); RunError  the richest model cannot be
/// moved. Collective; the same on all ranks.
///
/// For the total error the reference is formulation cfr on a fine mesh in fine steps (exact_motion.h), and floating
/// frames, elements and strains are chosen before: the coarsest that leave less than two thirds of the accuracy. Where
/// that is not to be had, it is the error of reduction, step and mesh, and the rest is named (Chosen::unbounded). Where
/// no model within the accuracy is found and the scene's own is closer to the reference, that is kept.
Chosen choose(const scene::Scene& scene, const scene::Accuracy& accuracy, MPI_Comm comm);

/// What models are measured against.
struct Reference {
  bool total = false;
  const Series* series = nullptr;  ///< null: the richest model of the candidate basis in fine steps
  double error = 0;                ///< of it; without a series: to be added, of the mesh
  double of_step = 0;              ///< error of the scene's step in the formulation of the series
};
/// The reduced model of a scene as it is discretised. Collective; as choose().
Chosen choose_within(const scene::Scene& scene, double accuracy, MPI_Comm comm, const Reference& reference);
/// choose() for the total error.
Chosen choose_total(const scene::Scene& scene, double accuracy, MPI_Comm comm);

/// Another model like `chosen.model`, at its start. Collective.
assembly::Model another_model(const Chosen& chosen, MPI_Comm comm);

/// The scene that has the chosen model, into a file; bodies that no scene can specify are written beside it.
/// @return what was written; @throws InputError, RunError on every rank. Collective.
std::vector<std::string> write_scene(const Chosen& chosen, const std::string& path, bool overwrite, MPI_Comm comm);

/// In one line: meshes and frames, basis vectors, step.
std::string summary_of(const Chosen& chosen);
nlohmann::ordered_json to_json(const Chosen& chosen);
output::Table decisions_table(const Chosen& chosen);

}  // namespace floe::app
