#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "compare_table.h"

namespace floe::app {

/// One model of a scene on the way from cheap to accurate.
struct Member {
  std::string family;  ///< `modes`, `modes and derivatives`, `step`, ...: what is varied
  std::string name;    ///< `3 modes + all derivatives`
  scene::Scene scene;
  scene::Formulation formulation;
};

/// The ladder: linear elastic forces, rigid bodies, 1 to m modes alone and with all their derivatives or with a few by
/// modal interaction, static columns, and the scene's own model with longer steps and other settings of the
/// integrator. What the scene itself asks for is among them (family `scene`).
std::vector<Member> ladder(const scene::Scene& scene);

/// What became of a member, against the reference.
struct Rung {
  std::string family, name, formulation;
  std::string stopped;  ///< why there are no errors: `diverged at t = 1.2 s`
  std::int64_t coordinates = 0;
  double offline = 0, motion = 0;  ///< [s]
  std::int64_t steps = 0;
  std::vector<double> rms, peak;  ///< relative, of each probe as a vector
  double energy = 0;              ///< relative, root mean square of kinetic and elastic energy
  std::vector<double> estimate;   ///< of each probe; empty: none
  double worst() const;           ///< greatest rms of all probes
};

/// Numbers of `rungs` such that no other one is both cheaper (motion) and more accurate; the cheapest first.
std::vector<std::size_t> pareto_front(const std::vector<Rung>& rungs);

/// The cheapest rung with errors below `accuracy`, else the most accurate one; none where all have stopped.
std::optional<std::size_t> choice(const std::vector<Rung>& rungs, double accuracy);

struct TradeoffRequest {
  scene::Formulation reference = scene::Formulation::nlffr;
  double accuracy = 0.01;
};

/// Runs the reference, the reference with mesh and step halved, and the ladder; writes tradeoff.csv, tradeoff.md,
/// tradeoff.json and tradeoff.png into the folder. The reference is moved by all ranks together, the ladder's members
/// by one rank each, so many at a time as there are ranks. A member that stops is a result, too.
/// @throws InputError, RunError  the reference failed. Collective.
void tradeoff(const scene::Scene& scene, MPI_Comm comm, const TradeoffRequest& request, const std::string& folder,
              bool overwrite);

}  // namespace floe::app
