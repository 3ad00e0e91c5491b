#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "floe/assess/budget.h"
#include "run.h"

namespace floe::app {

/// The parts of the error of a finished reduced motion (of equilibria without a step) beside that of the reduction, and
/// the total, for the summary's `estimate`: step, model, mesh, total; each with the relative errors of the probes, or
/// why there is none; `largest`: where a part is above 1 %, the largest one, and what makes it smaller, also as a
/// warning of the result. Collective; a fault within a part only leaves that part out.
/// @param no_model  why the error of the model is not to be estimated; empty: it is
/// @param required  total that the model was selected for: no part is the largest where it is met
/// @param made_rigid  bodies that the selection made rigid: the total lacks the errors of this
nlohmann::ordered_json error_budget(const assess::FinishedMotion& motion, const assess::KeptMotion& kept,
                                    const std::string& no_model, RunResult& result, std::optional<double> required = {},
                                    const std::vector<std::string>& made_rigid = {});

/// `total 7.2 %: reduction 0.053 %, model 7.3 %, mesh 0.16 %, step 0.021 %`, of the probe with the largest total
/// (`total of the known parts` where one is missing); or why there is none.
std::string budget_line(const nlohmann::ordered_json& estimate);

/// The table: probe, reduction, model, mesh, step, total; then where each part comes from, or why there is none.
/// @param estimate  of the summary; @param end  of the motion [s]
std::string budget_words(const nlohmann::ordered_json& estimate, double end);

}  // namespace floe::app
