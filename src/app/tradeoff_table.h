#pragma once
#include "tradeoff.h"

namespace floe::app {

/// A row for each model: unknowns, times, errors in per cent with the part due to the reduction, the estimate beside
/// them, its number on the Pareto front.
/// @param full  whether all columns and all probes are wanted; else those that fit a terminal, of the worst probe
output::Table tradeoff_table(const std::vector<std::string>& probes, const std::vector<ModelVariant>& variants,
                             bool full);

/// The models selected by `accuracy:`: required, true and estimated total, and their time over that of the fastest
/// other model with at most the required error.
output::Table selections_table(const std::vector<ModelVariant>& variants);

/// Everything that the picture and the documentation need, without series.
nlohmann::ordered_json to_json(const ModelVariant& variant);
ModelVariant variant_of(const nlohmann::ordered_json& j);
nlohmann::ordered_json to_json(const TradeoffReference& reference);

}  // namespace floe::app
