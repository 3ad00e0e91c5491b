#pragma once
#include "run.h"

namespace floe::app {

/// Where a static search goes: t from 0 to `at` in equal steps, an equilibrium at each.
struct LoadSteps {
  double at = 1;
  int steps = 1;
  /// Along the path by arc length instead, in increments of t of at most at / steps, at most so many points.
  bool path = false;
  int points = 1000;
};

/// Builds one scene in one formulation and finds its equilibria: `floe static`. That at t = 0 is the first row of the
/// probes, then one row for each step; a step that finds none is halved, down to a thousandth of `at`. With `path` one
/// row for each point of solve::follow_path, without an estimate.
///
/// @param folder    none: nothing is written
/// @param estimate  of the error, of reduced formulations (assess::estimate_error_at_rest)
/// @throws InputError; RunError: no equilibrium, with the t. What was reached before is written. Collective.
RunResult rest(const scene::Scene& scene, scene::Formulation formulation, MPI_Comm comm, const LoadSteps& load,
               const std::optional<output::ResultFolder>& folder, bool estimate);

/// `floe static`: the search, and its table. Collective.
void solve_static(const scene::Scene& scene, scene::Formulation formulation, MPI_Comm comm, const LoadSteps& load,
                  const output::ResultFolder& folder, bool estimate);

}  // namespace floe::app
