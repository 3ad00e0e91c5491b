#pragma once
#include "equilibrium.h"
#include "floe/solve/simulation.h"
#include "recorder.h"

namespace floe::app {

/// The path of equilibria of `floe static --path`: rows of the recorder, limit points and bifurcations in the summary
/// (`path`) and among the warnings.
///
/// @param begun  there is an equilibrium at t = 0; else the path begins at that after the first increment
/// @throws RunError  the path cannot be followed. Collective.
void follow_load_path(const assembly::Model& model, const LoadSteps& load, bool begun, Recorder& recorder,
                      assess::KeptMotion& kept, solve::IntegrationReport& report, RunResult& result);

}  // namespace floe::app
