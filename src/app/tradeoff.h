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
  double accuracy = 0;  ///< above 0: the model is chosen for this error (choose.h)
};

/// The ladder: linear elastic forces, rigid bodies, 1 to m modes alone and with all their derivatives or with a few by
/// modal interaction, static columns, and the scene's own model with longer steps and other settings of the
/// integrator. What the scene itself asks for is among them (family `scene`), and what floe chooses for 5 %, 1 % and
/// 0.2 % (family `accuracy`).
std::vector<Candidate> ladder(const scene::Scene& scene);

/// What became of a member, against the reference.
struct Rung {
  std::string family, name, formulation;
  std::string stopped;  ///< why there are no errors: `diverged at t = 1.2 s`
  std::int64_t coordinates = 0;
  double offline = 0, motion = 0;  ///< [s]
  std::int64_t steps = 0;
  std::vector<double> rms, peak;  ///< relative, of each probe as a vector
  std::vector<double> reduction;  ///< rms against the reference with the scene's own steps: what an estimate is of
  double energy = 0;              ///< relative, root mean square of kinetic and elastic energy
  std::vector<double> estimate;   ///< of each probe; empty: none
  double worst() const;           ///< greatest rms of all probes
};

/// Numbers of `rungs` such that no other one is both cheaper (motion) and more accurate; the cheapest first.
std::vector<std::size_t> pareto_front(const std::vector<Rung>& rungs);

/// The cheapest rung with errors of at most `accuracy`, if there is one.
std::optional<std::size_t> choice(const std::vector<Rung>& rungs, double accuracy);

struct TradeoffRequest {
  scene::Formulation reference = scene::Formulation::nlffr;
  double accuracy = 0.01;
};

/// Runs the reference, the reference with a quarter of the step, against which all errors are, that with the mesh
/// halved, too, and the ladder; writes tradeoff.csv, tradeoff.md,
/// tradeoff.json and tradeoff.png into the folder. The reference is moved by all ranks together, the ladder's members
/// by one rank each, so many at a time as there are ranks. A member that stops is a result, too.
/// @throws InputError, RunError  the reference failed. Collective.
void tradeoff(const scene::Scene& scene, MPI_Comm comm, const TradeoffRequest& request, const std::string& folder,
              bool overwrite);

}  // namespace floe::app
