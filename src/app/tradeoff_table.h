#pragma once
#include "tradeoff.h"

namespace floe::app {

/// A row for each rung, the reference first: what it is, unknowns, times, errors in per cent, the estimate beside them.
/// @param full      whether all columns are wanted; else those that fit a terminal
/// @param chosen    number of the rung to point out
output::Table tradeoff_table(const std::vector<std::string>& probes, const Rung& reference, const Rung* own,
                             const std::vector<Rung>& rungs, std::optional<std::size_t> chosen, bool full);

/// Everything that the picture and the documentation need, without series.
nlohmann::ordered_json to_json(const Rung& rung);
Rung rung_of(const nlohmann::ordered_json& j);

}  // namespace floe::app
