#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "compare_table.h"

namespace floe::app {

/// One model of a scene on the way from cheap to accurate.
struct Candidate {
  std::string family;  ///< `modes`, `modes and derivatives`, `step`, ...: what is varied
  std::string name;    ///< `3 modes + all derivatives`
  scene::Scene scene;
  scene::Formulation formulation;
  double accuracy = 0;          ///< above 0: the model is selected for this total error (choose.h)
  std::string impossible = {};  ///< why there is no such model; empty: there is one
};

/// The model hierarchy: rigid bodies, linear elastic forces, 1 to m modes alone and with all their derivatives or with
/// a few by modal interaction, attachment modes, residual responses, elastic forces, 1 to 8 floating frames, elements
/// twice and half as long, strains, other steps and settings of the integrator, full-order models (nlffr, lffr, cfr) of
/// such meshes, frames and steps, and the models that floe selects for a total error of 5 %, 1 % and 0.2 % (family
/// `accuracy`). The scene's own model is among them (family `scene`).
std::vector<Candidate> hierarchy(const scene::Scene& scene);

/// What became of a member, against the reference.
struct ModelVariant {
  std::string family, name, formulation;
  std::string stopped;  ///< why there are no errors: `diverged at t = 1.2 s`
  std::int64_t coordinates = 0;
  double offline = 0, motion = 0;  ///< [s]; motion: processor time
  std::int64_t steps = 0;
  std::vector<double> total, peak;  ///< relative, of each probe as a vector: root mean square, and of maxima
  std::vector<double> reduction;    ///< rms against the full-order model of its mesh, frames, strains and step
  double energy = 0;                ///< relative, root mean square of kinetic and elastic energy
  std::vector<double> estimate;     ///< estimated total of each probe; empty: none
  std::string lacks;                ///< parts that the estimate does not contain: `model, mesh`
  double required = 0;              ///< selected for this total error
  std::string selected;             ///< what was selected: `20 elements in 4 frames; 8 of 43; 0.008 s`
  double worst() const;             ///< greatest total of all probes; infinity where there is none
};

/// Indices of variants such that no other one is both cheaper (motion) and more accurate; the cheapest first.
std::vector<std::size_t> pareto_front(const std::vector<ModelVariant>& variants);

/// The cheapest model variant with errors of at most `accuracy`, if there is one.
std::optional<std::size_t> choice(const std::vector<ModelVariant>& variants, double accuracy);

struct TradeoffRequest {
  std::optional<scene::Formulation> reference;  ///< absent: cfr where it can simulate the scene, else nlffr
  double accuracy = 0.01;
  double most_seconds = 60;  ///< processor time of one simulation of cfr for the reference, or of a full-order model
};

/// What all errors are relative to (tradeoff_reference.cpp).
struct TradeoffReference {
  scene::Formulation formulation = scene::Formulation::cfr;
  std::string words;  ///< `cfr, elements 1/4 as long, steps 1/2 as long, extrapolated`
  std::string why;    ///< why it is not cfr; empty: it is, or was requested
  Series series;
  double error = 0;         ///< of its own, estimated, of the worst probe
  std::string error_lacks;  ///< what that does not contain: `the error of strains and floating frames`
};

/// Formulation cfr, converged in mesh and step (exact_motion.h), for errors down to the smallest required one; where it
/// does not support the scene, or one simulation takes more than request.most_seconds, the full-order model on elements
/// half as long in a quarter of the step.
/// @param own  the full-order model (nlffr) of the scene's own mesh and step
/// @throws InputError  cfr was requested and is not possible; RunError. Collective.
TradeoffReference tradeoff_reference(const scene::Scene& scene, const TradeoffRequest& request, const Series& own,
                                     MPI_Comm comm);

/// Simulates the reference, the full-order model and the hierarchy; writes tradeoff.csv, tradeoff.md, tradeoff.json and
/// tradeoff.png into the folder. The reference is simulated by all ranks together, the members of the hierarchy by one
/// rank each, so many at a time as there are ranks. A member that stops is a result, too.
/// @throws InputError, RunError  the reference failed. Collective.
void tradeoff(const scene::Scene& scene, MPI_Comm comm, const TradeoffRequest& request, const std::string& folder,
              bool overwrite);

}  // namespace floe::app
