#pragma once
#include <nlohmann/json.hpp>

#include "run.h"

namespace floe::app {

/// What summary.json says when a motion begins: scene, provenance, unknowns, bodies with their basis, motion.
nlohmann::ordered_json first_summary(const scene::Scene& scene, const assembly::Model& model, MPI_Comm comm,
                                     const RunResult& result);

/// That the velocities at the start were changed to those of the joints and drives, by more than 1 %; else empty.
std::string changed_start(const scene::Scene& scene, const assembly::Model& model);

/// Its part `estimate`: the error of the reduction for each probe, or why there is none.
nlohmann::ordered_json estimate_json(const assess::Estimate& estimate, const assembly::Model& model);

}  // namespace floe::app
